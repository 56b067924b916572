#pragma once  // SPDX-License-Identifier: MIT

#include <functional>
#include <optional>
#include <string>

#include "examples/live/options.hpp"
#include "examples/live/outputs/line_feed.hpp"
#include "examples/live/outputs/recorder.hpp"
#include "examples/live/outputs/rtsp_output.hpp"
#include "examples/live/outputs/video_feed.hpp"
#include "examples/live/pipeline/frame_review.hpp"
#include "examples/live/pipeline/frame_store.hpp"
#include "examples/live/pipeline/live_pipeline.hpp"
#include "examples/live/pipeline/properties.hpp"

namespace live {

/// A pipeline and all who look at it. Frames go from the pipeline to the store, to RTSP and to the
/// recording in its own thread; everything else happens in the main loop.
class Session {
 public:
  /// @param on_failure  The source cannot be used; called in the main loop.
  /// Throws std::runtime_error where what was asked for cannot be set up.
  Session(const Options& options, std::function<void()> on_failure);

  /// Plays another source. Throws std::invalid_argument where it is none.
  /// @param fps  Of a folder, for parse_rate(); empty = the usual one.
  void open(const std::string& source, const std::string& fps);

  /* A file is paused itself. A live source goes on, and the view of it is held. */
  void play();
  void pause();
  void step();
  /// [ns]. @return false where the source cannot be sought.
  bool seek(GstClockTime position);
  [[nodiscard]] bool is_playing() const;
  /// To be called when settings have changed: a frame that stands still is analysed again with
  /// them, as a seek to it would, and is shown in the place of the old one.
  void review();

  [[nodiscard]] FrameStore& store() { return store_; }
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
  VideoFeed video_;
  LineFeed lines_;
  std::optional<RtspOutput> rtsp_;
  std::optional<Recorder> recorder_;
  LivePipeline pipeline_;  // last of those who get frames: it stops before they are gone
  Properties properties_;
  FrameReview review_;
  bool reviews_again_ = false;  // settings have changed since the review began
};

}  // namespace live
