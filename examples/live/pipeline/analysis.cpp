// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/analysis.hpp"

#include <algorithm>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/detection/evidence.hpp"
#include "core/tracking/tracker.hpp"
#include "examples/live/ellipse_json.hpp"
#include "gst/track/video_view.hpp"

namespace live {
namespace {

constexpr std::size_t kMaxCandidates = 2000;  // a few hundred bytes of JSON each

bool is_found(const ellipse::TracedCandidate& candidate) {
  return candidate.verdict.is_accepted() ||
         candidate.verdict.reason >= ellipse::Reason::kTooFarFromLast;
}

void write_passes(JsonWriter& json, const ellipse::DetectionTrace& trace) {
  json.key("passes").begin_array();
  for (const ellipse::TracedPass& pass : trace.passes()) {
    json.begin_object()
        .member("scale", pass.scale)
        .member("width", pass.width)
        .member("height", pass.height)
        .member("edge_low", pass.edge_low)
        .member("edge_high", pass.edge_high)
        .member("chains", pass.chains.size())
        .member("arcs", pass.arcs.size())
        .end_object();
  }
  json.end_array();
}

void write_evidence(JsonWriter& json, const ellipse::TracedCandidate& candidate) {
  const auto infos = ellipse::feature_infos();
  json.key("evidence").begin_array();
  for (std::size_t i = 0; i < infos.size(); ++i) {
    json.begin_object()
        .member("name", infos[i].nick)
        .member("description", infos[i].description)
        .member("value", candidate.features[i])
        .member("contribution", candidate.contributions[i])
        .end_object();
  }
  json.end_array();
}

void write_candidate(JsonWriter& json, const ellipse::TracedCandidate& candidate) {
  const ellipse::Verdict& verdict = candidate.verdict;
  json.begin_object()
      .member("pass", candidate.pass)
      .member("reason", ellipse::reason_info(verdict.reason).nick)
      .member("text", ellipse::to_text(verdict))
      .member("measured", verdict.measured)
      .member("limit", verdict.limit)
      .member("found", is_found(candidate))
      .member("is_target", candidate.is_target)
      .member("contour_overlap", candidate.contour_overlap)
      .member("ellipse_overlap", candidate.ellipse_overlap)
      .member("score", candidate.score)
      .member("probability", candidate.probability);
  if (candidate.contributions != ellipse::Features{}) write_evidence(json, candidate);
  json.key("ellipse");
  if (candidate.ellipse) {
    begin_ellipse(json, *candidate.ellipse).end_object();
  } else {
    json.null();
  }
  json.end_object();
}

// Found ellipses come first, so truncation never drops them.
void write_candidates(JsonWriter& json, const ellipse::DetectionTrace& trace) {
  std::vector<const ellipse::TracedCandidate*> candidates;
  for (const auto& candidate : trace.candidates()) candidates.push_back(&candidate);
  std::stable_partition(
      candidates.begin(), candidates.end(), [](const auto* each) { return is_found(*each); });
  std::map<ellipse::Reason, std::size_t> counts;
  for (const auto* candidate : candidates) ++counts[candidate->verdict.reason];
  json.key("candidates").begin_array();
  for (const auto* candidate :
       std::span(candidates).first(std::min(candidates.size(), kMaxCandidates))) {
    write_candidate(json, *candidate);
  }
  json.end_array().key("counts").begin_object();
  for (const auto& [reason, count] : counts) {
    json.member(ellipse::reason_info(reason).nick, count);
  }
  json.end_object().key("reasons").begin_object();
  for (const auto& [reason, count] : counts) {
    const ellipse::ReasonInfo& info = ellipse::reason_info(reason);
    json.key(info.nick)
        .begin_object()
        .member("description", info.description)
        .member("quantity", info.quantity)
        .member("unit", info.unit)
        .member("setting", info.setting)
        .end_object();
  }
  json.end_object();
}

// Writes the picture as a data URL, or null if no pass was traced.
void write_picture(JsonWriter& json, const ellipse::DetectionTrace& trace, ellipse::Stage stage) {
  json.key("picture");
  if (trace.passes().empty()) {
    json.null();
    return;
  }
  ellipse::RgbPicture picture = ellipse::draw_stage(trace, trace.passes().size() - 1, stage);
  const cv::Mat rgb(picture.height, picture.width, CV_8UC3, picture.pixels.data());
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<unsigned char> png;
  cv::imencode(".png", bgr, png, {cv::IMWRITE_PNG_COMPRESSION, 1});
  const Ref<gchar> text(g_base64_encode(png.data(), png.size()));
  json.value("data:image/png;base64," + std::string(text.get()));
}

}  // namespace

std::string analysis_json(const AnalysisRequest& request) {
  GstVideoInfo info;
  GstSample* sample = request.frame->sample.get();
  gst_video_info_from_caps(&info, gst_sample_get_caps(sample));
  MappedFrame mapped(info, gst_sample_get_buffer(sample), GST_MAP_READ);
  if (!mapped.is_mapped()) throw std::runtime_error("cannot map the frame");
  const ellipse::PixelView view = pixel_view_of(mapped.frame());
  ellipse::TrackerSettings settings = request.settings;
  settings.tracking = ellipse::TrackingMode::kNone;

  // The first run is timed. The second one records the trace, which takes time itself.
  const gint64 start_us = g_get_monotonic_time();
  (void)ellipse::Tracker(settings).process(view, 0);
  const gint64 time_us = g_get_monotonic_time() - start_us;
  ellipse::DetectionTrace trace;
  ellipse::Tracker tracker(settings);
  tracker.set_trace(&trace);
  (void)tracker.process(view, 0);

  JsonWriter json;
  json.begin_object()
      .member("pts_ns", request.frame->pts)
      .member("width", request.frame->width)
      .member("height", request.frame->height)
      .member("detector", ellipse::detector_nicks()[static_cast<std::size_t>(settings.detector)])
      .member("processing_ns", 1000 * time_us);
  write_passes(json, trace);
  write_candidates(json, trace);
  if (request.stage) write_picture(json, trace, *request.stage);
  return json.end_object().text() + "\n";
}

}  // namespace live
