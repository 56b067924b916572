#pragma once  // SPDX-License-Identifier: MIT

#include <gst/app/app.h>
#include <gst/gst.h>

#include <functional>
#include <string>

#include "examples/live/pipeline/frame_tap.hpp"
#include "examples/live/pipeline/source_spec.hpp"

namespace live {

enum class PlayState { kStarting, kPlaying, kPausing, kPaused, kEnded, kReconnecting, kFailed };

[[nodiscard]] const char* nick_of(PlayState state);

/// The source, ellipsetrack and an appsink that passes each frame to the FrameTap, which only takes
/// references and never blocks.
///
/// The tracker element and its settings persist when the source is replaced or reconnects. Main
/// loop only.
class LivePipeline {
 public:
  using Notice = std::function<void(const std::string&)>;

  struct Handlers {
    FrameTap::FrameSink on_frame;      ///< Called in the streaming thread; must not block.
    Notice on_trouble;                 ///< The source's error; empty when it has recovered.
    std::function<void()> on_failure;  ///< The source failed and will not be retried.
  };

  /// Throws std::runtime_error that names a missing element.
  explicit LivePipeline(Handlers handlers);
  ~LivePipeline();
  LivePipeline(const LivePipeline&) = delete;
  LivePipeline& operator=(const LivePipeline&) = delete;

  /// Replaces the source and plays it. Errors go to the handlers.
  void open(SourceSpec spec, bool loops);
  /// Stops the source; no frame arrives afterwards.
  void close();

  void play();
  /// The state is kPausing until the frame in progress has been rendered.
  void pause();
  /// Shows the next frame, immediately or when a pause completes. After the last frame, the source
  /// ends or loops.
  void step();
  /// Seeks to a time [ns]. A paused source shows the frame immediately. A time past the end selects
  /// the last frame; if no frame follows, the source ends. @return false if the source cannot seek.
  bool seek(GstClockTime position);

  [[nodiscard]] GstElement* tracker() const { return tracker_; }
  [[nodiscard]] const SourceSpec& source() const { return spec_; }
  [[nodiscard]] PlayState state() const { return state_; }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] guint64 reconnections() const { return reconnections_; }
  [[nodiscard]] guint64 frames() const { return tap_.frames(); }
  [[nodiscard]] bool is_seekable() const;
  /// [ns]; GST_CLOCK_TIME_NONE if unknown.
  [[nodiscard]] GstClockTime position() const;
  [[nodiscard]] GstClockTime duration() const;

 private:
  static gboolean on_message(GstBus* bus, GstMessage* message, gpointer data);
  static gboolean on_tick(gpointer data);
  static gboolean on_retry(gpointer data);
  static gboolean on_poll(gpointer data);

  void start(GstState wanted = GST_STATE_PLAYING);
  void stop();
  void end_of_stream();
  void source_dropped(const std::string& why);
  void watch_arrivals();
  void begin_pause();
  void advance();
  void pause_after_frame();
  void finish_pause();
  [[nodiscard]] bool is_at_end() const;
  void rewind();
  void cancel_retry();

  Handlers handlers_;
  SourceSpec spec_;
  bool loops_ = false;
  GstElement* pipeline_;
  GstElement* tracker_;
  GstElement* sink_;
  FrameTap tap_;
  GstElement* source_ = nullptr;
  guint bus_watch_ = 0;
  guint tick_ = 0;
  guint retry_ = 0;
  guint poll_ = 0;
  guint retries_ = 0;  // since the last frame
  PlayState state_ = PlayState::kStarting;
  std::string trouble_;
  guint steps_ = 0;            // pending until the pause is complete
  bool is_moving_ = false;     // a step or a seek is in progress
  guint64 frames_before_ = 0;  // frame count when that step or seek began
  guint64 frames_at_rewind_ = 0;
  guint64 rendered_before_ = 0;  // count when playback was last requested
  guint64 reconnections_ = 0;
  guint64 frames_at_tick_ = 0;
  guint ticks_without_frames_ = 0;
  bool has_begun_ = false;  // a frame has arrived since the source was started
};

}  // namespace live
