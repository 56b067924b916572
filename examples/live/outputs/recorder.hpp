#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "examples/live/pipeline/frame.hpp"
#include "examples/live/pipeline/wakeup.hpp"

namespace live {

/// Records the pipeline's frames: H.264 to FILE.mkv and the JSON lines to FILE.ndjson. When the
/// frame size changes, recording continues in FILE-2.mkv. A slow disk causes dropped frames and
/// never blocks the pipeline.
class Recorder {
 public:
  /// @param on_trouble  Called in the main loop when recording has stopped with an error.
  /// Throws std::runtime_error if the file cannot be written or no H.264 encoder is installed.
  Recorder(std::filesystem::path file, std::function<void(const std::string&)> on_trouble);
  /// Finishes the files; blocks for at most 5 s.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Called in the streaming thread; never blocks.
  void put(const FramePtr& frame);

 private:
  static gboolean on_message(GstBus* bus, GstMessage* message, gpointer data);
  void open();
  void close();
  void send_eos();

  std::filesystem::path file_;
  std::function<void(const std::string&)> on_trouble_;
  int files_ = 0;
  GstElement* pipeline_ = nullptr;
  guint bus_watch_ = 0;
  Ref<GstElement> video_;
  Ref<GstElement> lines_;
  std::atomic<bool> takes_frames_{false};
  int width_ = 0;  // of this file; used by the streaming thread only
  int height_ = 0;
  Wakeup other_size_;
};

}  // namespace live
