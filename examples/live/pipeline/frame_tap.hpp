#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>
#include <gst/gst.h>

#include <atomic>
#include <functional>

#include "examples/live/pipeline/frame.hpp"

namespace live {

/// Makes a Frame of each buffer that leaves the tracker. In the streaming thread, but for its
/// making.
class FrameTap {
 public:
  using FrameSink = std::function<void(FramePtr)>;

  /// Both elements are borrowed, and must have stopped before this goes away.
  /// @param on_frame  In the streaming thread: must not wait.
  FrameTap(GstElement* tracker, GstAppSink* sink, FrameSink on_frame);
  FrameTap(const FrameTap&) = delete;
  FrameTap& operator=(const FrameTap&) = delete;

  /// How many there were. Any thread.
  [[nodiscard]] guint64 frames() const { return frames_; }
  /// How often the sink has shown one while it played; what was shown in a pause comes again. Any
  /// thread.
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
  Ref<GstBuffer> input_;  // of the frame that is being analysed
  gint64 arrived_us_ = 0;
};

}  // namespace live
