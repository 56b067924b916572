// SPDX-License-Identifier: MIT
#include "examples/landing/eye.hpp"

#include <gst/ellipse/gstellipsemeta.h>
#include <gst/video/video.h>

#include <cmath>

#include "examples/evaluate/text.hpp"

namespace landing {
namespace {

std::string line_of(int width, int height, int rate, const std::string& properties) {
  return evaluate::format(
      "appsrc name=source format=time caps=video/x-raw,format=GRAY8,width=%d,height=%d,"
      "framerate=%d/1 ! ellipsetrack name=track qos=false messages=none %s ! "
      "appsink name=sink sync=false",
      width,
      height,
      rate,
      properties.c_str());
}

}  // namespace

Eye::Eye(int width, int height, int rate, const std::string& properties)
    : width_(width),
      height_(height),
      rate_(rate),
      pipeline_(line_of(width, height, rate, properties)),
      source_(pipeline_.element("source")),
      track_(pipeline_.element("track")),
      sink_(pipeline_.element("sink")) {
  pipeline_.play();
}

void Eye::tell_gravity(const Eigen::Vector3d& gravity) {
  GValue down = G_VALUE_INIT;
  gst_value_array_init(&down, 3);
  for (const double coordinate : gravity) {
    GValue number = G_VALUE_INIT;
    g_value_init(&number, G_TYPE_DOUBLE);
    g_value_set_double(&number, coordinate);
    gst_value_array_append_and_take_value(&down, &number);
  }
  g_object_set_property(G_OBJECT(track_.get()), "gravity", &down);
  g_value_unset(&down);
}

void Eye::forget() {
  g_signal_emit_by_name(track_.get(), "reset");
}

Look Eye::look(const Eigen::Vector3d& gravity,
               const std::function<void(const ellipse::MutableImage&)>& draw) {
  tell_gravity(gravity);
  const int stride = GST_ROUND_UP_4(width_);
  const auto size = static_cast<gsize>(stride) * static_cast<gsize>(height_);
  GstBuffer* buffer = gst_buffer_new_allocate(nullptr, size, nullptr);
  GstMapInfo map;
  gst_buffer_map(buffer, &map, GST_MAP_WRITE);
  draw({map.data, width_, height_, stride});
  gst_buffer_unmap(buffer, &map);
  const auto rate = static_cast<guint64>(rate_);
  GST_BUFFER_PTS(buffer) = gst_util_uint64_scale(frame_++, GST_SECOND, rate);
  GST_BUFFER_DURATION(buffer) = GST_SECOND / rate;

  Look look;
  pipeline_.push(source_, buffer);
  look.sample = pipeline_.pull(sink_);
  const GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(gst_sample_get_buffer(look.sample.get()),
                                                           GST_ELLIPSE_ROLE_TARGET);
  look.has_target = meta != nullptr;
  if (look.has_target && meta->has_position != FALSE) {
    look.position = {meta->position_x, meta->position_y, meta->position_z};
    const gdouble* covariance = meta->position_covariance;  // xx, xy, xz, yy, yz, zz
    look.error = std::sqrt(covariance[0] + covariance[3] + covariance[5]);
    look.visible_fraction = meta->visible_fraction;
  }
  return look;
}

}  // namespace landing
