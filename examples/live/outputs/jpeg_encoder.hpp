#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>

#include <functional>
#include <mutex>

#include "examples/live/pipeline/frame.hpp"
#include "examples/live/pipeline/wakeup.hpp"

namespace live {

/// A frame encoded for viewers.
struct Picture {
  guint64 number = 0;     ///< Frame::number.
  GstClockTime pts = 0;   ///< [ns]
  gint64 arrived_us = 0;  ///< Frame::arrived_us.
  Ref<GBytes> jpeg = {};
  Ref<GBytes> stamped = {};  ///< The PTS in 8 bytes, little-endian, followed by the JPEG.
};

/// Encodes frames as JPEG on request, one at a time, in its own thread. Main loop only.
class JpegEncoder {
 public:
  /// @param quality     1 to 100.
  /// @param on_picture  Called in the main loop.
  ///
  /// Throws std::runtime_error if jpegenc is not installed.
  JpegEncoder(int quality, std::function<void(Picture)> on_picture);
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// Starts to encode a frame. Requires !is_busy(). If encoding fails, there is no picture.
  void encode(const FramePtr& frame);
  [[nodiscard]] bool is_busy() const { return frame_ != nullptr; }
  [[nodiscard]] guint64 encoded() const { return encoded_; }

 private:
  static GstFlowReturn on_sample(GstAppSink* sink, gpointer data);
  static gboolean on_message(GstBus* bus, GstMessage* message, gpointer data);
  void finish();
  void recover();

  std::function<void(Picture)> on_picture_;
  FramePtr frame_;  // being encoded; null = idle
  guint64 encoded_ = 0;
  GstElement* pipeline_;
  Ref<GstElement> source_;
  guint bus_watch_ = 0;
  Wakeup wakeup_;
  std::mutex mutex_;
  Ref<GstSample> result_;
};

}  // namespace live
