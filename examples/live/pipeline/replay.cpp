// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/replay.hpp"

#include <array>
#include <stdexcept>

#include "core/tracking/tracker.hpp"
#include "examples/live/ellipse_json.hpp"
#include "gst/track/video_view.hpp"

namespace live {
namespace {

constexpr std::array kStateNicks = {"detected", "tracked", "predicted"};  // of TargetState

void write_target(JsonWriter& json, const std::optional<ellipse::Target>& target) {
  json.key("target");
  if (!target) {
    json.null();
    return;
  }
  begin_ellipse(json, target->ellipse)
      .member("state", kStateNicks[static_cast<std::size_t>(target->state)])
      .member("probability", target->probability)
      .end_object();
}

void write_found(JsonWriter& json, const ellipse::Tracker& tracker) {
  json.key("found").begin_array();
  for (const ellipse::Detection& each : tracker.candidates()) {
    begin_ellipse(json, each.ellipse).end_object();
  }
  json.end_array();
}

void write_frame(JsonWriter& json,
                 ellipse::Tracker& tracker,
                 const Frame& frame,
                 const ReplayRequest& request) {
  GstVideoInfo info;
  gst_video_info_from_caps(&info, gst_sample_get_caps(frame.sample.get()));
  MappedFrame mapped(info, gst_sample_get_buffer(frame.sample.get()), GST_MAP_READ);
  if (!mapped.is_mapped()) throw std::runtime_error("cannot map a stored frame");
  const ellipse::PixelView view = pixel_view_of(mapped.frame());
  const auto target =
      tracker.process(view,
                      static_cast<std::int64_t>(frame.pts),
                      {.within = request.region.value_or(view.bounds()), .finest_scale = 1});
  json.begin_object().member("frame", frame.index);
  write_target(json, target);
  if (request.is_single) write_found(json, tracker);
  json.end_object();
}

}  // namespace

std::string replay_json(const ReplayRequest& request, const std::stop_token& stop) {
  ellipse::TrackerSettings settings = request.settings;
  if (request.is_single) settings.tracking = ellipse::TrackingMode::kNone;
  ellipse::Tracker tracker(settings);
  JsonWriter json;
  json.begin_object().key("frames").begin_array();
  for (const FramePtr& frame : request.frames) {
    if (stop.stop_requested()) throw std::runtime_error("the program is shutting down");
    if (request.is_single) tracker.reset();
    write_frame(json, tracker, *frame, request);
  }
  return json.end_array().end_object().text() + "\n";
}

}  // namespace live
