#pragma once  // SPDX-License-Identifier: MIT

#include <functional>
#include <optional>
#include <string>

#include "examples/live/options.hpp"
#include "examples/live/outputs/line_feed.hpp"
#include "examples/live/outputs/recorder.hpp"
#include "examples/live/outputs/rtsp_output.hpp"
#include "examples/live/outputs/video_feed.hpp"
#include "examples/live/pipeline/frame_history.hpp"
#include "examples/live/pipeline/frame_review.hpp"
#include "examples/live/pipeline/frame_store.hpp"
#include "examples/live/pipeline/live_pipeline.hpp"
#include "examples/live/pipeline/properties.hpp"

namespace live {

/// Connects a pipeline to its outputs. The streaming thread passes frames to the store, RTSP and
/// the recording; everything else runs in the main loop.
class Session {
 public:
  /// @param on_failure  Called in the main loop when the source has failed and is not retried.
  /// Throws std::runtime_error if the pipeline, RTSP or the recording cannot be set up.
  Session(const Options& options, std::function<void()> on_failure);

  /// Replaces the source. Throws std::invalid_argument if it is invalid.
  /// @param fps  For a folder, see parse_rate(); empty = default.
  void open(const std::string& source, const std::string& fps);

  /* These pause a file. A live source continues, and only the view is held. */
  void play();
  void pause();
  void step();
  /// @param position  [ns]
  /// @return false if the source cannot seek.
  bool seek(GstClockTime position);
  [[nodiscard]] bool is_playing() const;
  /// Pauses and shows a frame of the history.
  void show(FramePtr frame);
  /// Call after settings have changed. Analyses a paused or held frame again with the new settings
  /// and replaces it.
  void review();

  [[nodiscard]] FrameStore& store() { return store_; }
  [[nodiscard]] FrameHistory& history() { return history_; }
  [[nodiscard]] LivePipeline& pipeline() { return pipeline_; }
  [[nodiscard]] VideoFeed& video() { return video_; }
  [[nodiscard]] LineFeed& lines() { return lines_; }
  [[nodiscard]] Properties& properties() { return properties_; }
  [[nodiscard]] const std::optional<RtspOutput>& rtsp() const { return rtsp_; }

 private:
  void on_frame(FramePtr frame);
  void on_change();
  void on_review(const FramePtr& before, FramePtr after);

  bool loops_;
  FrameStore store_;
  FrameHistory history_;
  VideoFeed video_;
  LineFeed lines_;
  std::optional<RtspOutput> rtsp_;
  std::optional<Recorder> recorder_;
  LivePipeline pipeline_;  // the last consumer: stops before the others are destroyed
  Properties properties_;
  FrameReview review_;
  bool reviews_again_ = false;  // settings changed during the review
};

}  // namespace live
