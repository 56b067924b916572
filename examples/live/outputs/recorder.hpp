#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "examples/live/pipeline/frame.hpp"
#include "examples/live/pipeline/wakeup.hpp"

namespace live {

/// Writes what the pipeline delivers: H.264 into FILE.mkv, the JSON lines into FILE.ndjson. Frames
/// of another size go on in FILE-2.mkv. A slow disk loses frames and holds nobody up.
class Recorder {
 public:
  /// @param on_trouble  Called once in the main loop, where it cannot go on.
  /// Throws std::runtime_error where the file cannot be written, or no encoder is installed.
  Recorder(std::filesystem::path file, std::function<void(const std::string&)> on_trouble);
  /// Ends the file as a whole one; waits for that, some seconds at most.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The streaming thread; never waits.
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
  int width_ = 0;  // of this file; the streaming thread's
  int height_ = 0;
  Wakeup other_size_;
};

}  // namespace live
