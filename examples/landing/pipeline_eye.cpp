// SPDX-License-Identifier: MIT
#include "examples/landing/pipeline_eye.hpp"

#include <gst/ellipse/gstellipsemeta.h>

#include <cmath>

namespace landing {
namespace {

std::string line_of(const PictureFormat& format, const std::string& properties) {
  return "appsrc name=source format=time caps=" + format.caps() +
         " ! ellipsetrack name=track qos=false messages=none " + properties +
         " ! appsink name=sink sync=false";
}

}  // namespace

PipelineEye::PipelineEye(const PictureFormat& format, const std::string& properties)
    : format_(format),
      pipeline_(line_of(format, properties)),
      source_(pipeline_.element("source")),
      track_(pipeline_.element("track")),
      sink_(pipeline_.element("sink")) {
  pipeline_.play();
}

void PipelineEye::set_gravity(const Eigen::Vector3d& gravity) {
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

void PipelineEye::forget() {
  g_signal_emit_by_name(track_.get(), "reset");
}

Look PipelineEye::look(const Eigen::Vector3d& gravity, const Draw& draw) {
  set_gravity(gravity);
  Look look;
  pipeline_.push(source_, format_.draw(frame_++, draw));
  look.sample = pipeline_.pull(sink_);
  const GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(gst_sample_get_buffer(look.sample.get()),
                                                           GST_ELLIPSE_ROLE_TARGET);
  look.has_target = meta != nullptr;
  if (look.has_target && meta->has_position != FALSE) {
    look.position = {meta->position_x, meta->position_y, meta->position_z};
    const gdouble* c = meta->position_covariance;  // xx, xy, xz, yy, yz, zz
    look.covariance << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
    look.visible_fraction = meta->visible_fraction;
  }
  return look;
}

}  // namespace landing
