#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>
#include <gst/gst.h>

#include <atomic>
#include <functional>

#include "examples/live/pipeline/frame.hpp"

namespace live {

/// Makes a Frame of each buffer that leaves the tracker, in the streaming thread. Constructed and
/// destroyed in the main loop.
class FrameTap {
 public:
  using FrameSink = std::function<void(FramePtr)>;

  /// Borrows both elements; they must be stopped before the destructor runs.
  /// @param on_frame  Called in the streaming thread; must not block.
  FrameTap(GstElement* tracker, GstAppSink* sink, FrameSink on_frame);
  FrameTap(const FrameTap&) = delete;
  FrameTap& operator=(const FrameTap&) = delete;

  /// Number of frames. Thread-safe.
  [[nodiscard]] guint64 frames() const { return frames_; }
  /// Number of buffers rendered while playing. A buffer that was prerolled in a pause counts when
  /// playback resumes. Thread-safe.
  [[nodiscard]] guint64 rendered() const { return rendered_; }

 private:
  static GstPadProbeReturn on_arrival(GstPad* pad, GstPadProbeInfo* info, gpointer data);
  static GstFlowReturn on_sample(GstAppSink* sink, gpointer data);
  static GstFlowReturn on_preroll(GstAppSink* sink, gpointer data);
  void take(GstSample* sample);

  FrameSink on_frame_;
  std::atomic<guint64> frames_{0};
  std::atomic<guint64> rendered_{0};
  FramePtr last_;
  Ref<GstBuffer> input_;  // input buffer of the frame in the tracker
  gint64 arrived_us_ = 0;
};

}  // namespace live
