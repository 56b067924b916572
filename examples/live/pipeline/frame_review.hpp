#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>

#include <functional>
#include <mutex>

#include "examples/live/pipeline/frame.hpp"
#include "examples/live/pipeline/properties.hpp"
#include "examples/live/pipeline/wakeup.hpp"

namespace live {

/// Analyses a frame again outside the pipeline, with a new tracker that has the current settings.
/// The frame is that tracker's first one. This shows the effect of a changed setting on a paused
/// picture. Handles one frame at a time. Main loop only; the analysis runs in its own thread.
class FrameReview {
 public:
  /// @param before  The frame passed to begin().
  /// @param after   The new analysis of the same picture; nullptr if it failed.
  using Answer = std::function<void(const FramePtr& before, FramePtr after)>;

  explicit FrameReview(Answer answer);
  ~FrameReview();
  FrameReview(const FrameReview&) = delete;
  FrameReview& operator=(const FrameReview&) = delete;

  /// Requires !is_busy().
  void begin(const FramePtr& frame, const Properties& properties);
  [[nodiscard]] bool is_busy() const { return frame_ != nullptr; }

 private:
  static GstFlowReturn on_sample(GstAppSink* sink, gpointer data);
  static gboolean on_message(GstBus* bus, GstMessage* message, gpointer data);
  void finish();
  void stop();

  Answer answer_;
  FramePtr frame_;  // being analysed; null = idle
  GstElement* pipeline_ = nullptr;
  guint bus_watch_ = 0;
  Wakeup wakeup_;
  std::mutex mutex_;
  Ref<GstSample> result_;
};

}  // namespace live
