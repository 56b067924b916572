#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>

#include <functional>
#include <mutex>

#include "examples/live/pipeline/frame.hpp"
#include "examples/live/pipeline/properties.hpp"
#include "examples/live/pipeline/wakeup.hpp"

namespace live {

/// Analyses a frame that is shown once more, apart from the pipeline: a tracker of its own, with
/// the settings of now, to which it is the first frame. So a changed setting shows on a picture
/// that stands still. One at a time, in a thread of its own. For the main loop's thread.
class FrameReview {
 public:
  /// @param before  The frame that was to be analysed.
  /// @param after   The same picture; null where it could not be analysed.
  using Answer = std::function<void(const FramePtr& before, FramePtr after)>;

  explicit FrameReview(Answer answer);
  ~FrameReview();
  FrameReview(const FrameReview&) = delete;
  FrameReview& operator=(const FrameReview&) = delete;

  /// Only while not busy.
  void begin(const FramePtr& frame, const Properties& properties);
  [[nodiscard]] bool is_busy() const { return frame_ != nullptr; }

 private:
  static GstFlowReturn on_sample(GstAppSink* sink, gpointer data);
  static gboolean on_message(GstBus* bus, GstMessage* message, gpointer data);
  void finish();
  void stop();

  Answer answer_;
  FramePtr frame_;  // that is being analysed
  GstElement* pipeline_ = nullptr;
  guint bus_watch_ = 0;
  Wakeup wakeup_;
  std::mutex mutex_;
  Ref<GstSample> result_;
};

}  // namespace live
