// SPDX-License-Identifier: MIT
#include "examples/landing/peer_eye.hpp"

namespace landing {

PeerEye::PeerEye(const PictureFormat& format, std::unique_ptr<Peer> peer)
    : format_(format), peer_(std::move(peer)) {}

Look PeerEye::look(const Eigen::Vector3d& gravity, const Draw& draw) {
  std::optional<Sighting> seen;
  GstBuffer* buffer = format_.draw(frame_++, [&](const ellipse::MutableImage& picture) {
    draw(picture);
    seen = peer_->find({picture.data, picture.width, picture.height, picture.stride}, gravity);
  });
  Look look;
  GstCaps* caps = gst_caps_from_string(format_.caps().c_str());
  look.sample.reset(gst_sample_new(buffer, caps, nullptr, nullptr));
  gst_caps_unref(caps);
  gst_buffer_unref(buffer);
  look.has_target = seen.has_value();
  if (seen) {
    look.position = seen->position;
    look.covariance.diagonal().setConstant(seen->error() * seen->error());
    look.visible_fraction = 1.0;
  }
  return look;
}

}  // namespace landing
