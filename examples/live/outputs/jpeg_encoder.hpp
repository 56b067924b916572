#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>

#include <functional>
#include <mutex>

#include "examples/live/pipeline/frame.hpp"
#include "examples/live/pipeline/wakeup.hpp"

namespace live {

/// A frame as its viewers get it.
struct Picture {
  guint64 number = 0;     ///< That of its frame.
  GstClockTime pts = 0;   ///< [ns]
  gint64 arrived_us = 0;  ///< As that of its frame.
  Ref<GBytes> jpeg = {};
  Ref<GBytes> stamped = {};  ///< The PTS as eight bytes, lowest first, and the JPEG.
};

/// Turns a frame into a JPEG when it is asked to, in a thread of its own; one at a time. Idle
/// otherwise. For the main loop's thread.
class JpegEncoder {
 public:
  /// @param quality     1 to 100.
  /// @param on_picture  Called in the main loop.
  /// Throws std::runtime_error where GStreamer's jpegenc is missing.
  JpegEncoder(int quality, std::function<void(Picture)> on_picture);
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// Begins with this frame; only while not busy. A frame that cannot be encoded gives no picture.
  void encode(const FramePtr& frame);
  [[nodiscard]] bool is_busy() const { return frame_ != nullptr; }
  [[nodiscard]] guint64 encoded() const { return encoded_; }

 private:
  static GstFlowReturn on_sample(GstAppSink* sink, gpointer data);
  static gboolean on_message(GstBus* bus, GstMessage* message, gpointer data);
  void finish();
  void recover();

  std::function<void(Picture)> on_picture_;
  FramePtr frame_;  // the one that is being encoded
  guint64 encoded_ = 0;
  GstElement* pipeline_;
  Ref<GstElement> source_;
  guint bus_watch_ = 0;
  Wakeup wakeup_;
  std::mutex mutex_;
  Ref<GstSample> result_;
};

}  // namespace live
