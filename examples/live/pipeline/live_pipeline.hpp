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

/// Source, ellipsetrack and a sink that hands over each frame. Nothing behind that sink holds the
/// pipeline up: the FrameTap only takes references.
///
/// The tracker stays one and the same, with its settings, when the source is replaced or comes back
/// after it dropped. All functions are for the main loop's thread.
class LivePipeline {
 public:
  using Notice = std::function<void(const std::string&)>;

  struct Handlers {
    FrameTap::FrameSink on_frame;      ///< In the streaming thread: must not wait.
    Notice on_trouble;                 ///< What is wrong with the source, or that it is back.
    std::function<void()> on_failure;  ///< The source cannot be used and will not come back.
  };

  /// Throws std::runtime_error that names an element that is missing.
  explicit LivePipeline(Handlers handlers);
  ~LivePipeline();
  LivePipeline(const LivePipeline&) = delete;
  LivePipeline& operator=(const LivePipeline&) = delete;

  /// Plays this from now on. Trouble is told by the handlers.
  void open(SourceSpec spec, bool loops);
  /// No frame comes from now on.
  void close();

  void play();
  /// kPausing until the picture stands still: the frame that is under way is still shown.
  void pause();
  /// Shows the next frame of what is paused, or is about to be. Behind the last one it has ended,
  /// or begins again where it loops.
  void step();
  /// To a time [ns] of what can be sought; at once also where it is paused. A time behind the end
  /// is the last one; where no frame is there it has ended. @return false where it cannot.
  bool seek(GstClockTime position);

  [[nodiscard]] GstElement* tracker() const { return tracker_; }
  [[nodiscard]] const SourceSpec& source() const { return spec_; }
  [[nodiscard]] PlayState state() const { return state_; }
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] guint64 reconnections() const { return reconnections_; }
  [[nodiscard]] guint64 frames() const { return tap_.frames(); }
  [[nodiscard]] bool is_seekable() const;
  /// [ns]; GST_CLOCK_TIME_NONE where it is not known.
  [[nodiscard]] GstClockTime position() const;
  [[nodiscard]] GstClockTime duration() const;

 private:
  static gboolean on_message(GstBus* bus, GstMessage* message, gpointer data);
  static gboolean on_glance(gpointer data);
  static gboolean on_retry(gpointer data);
  static gboolean on_look(gpointer data);

  void start(GstState wanted = GST_STATE_PLAYING);
  void stop();
  void end_of_stream();
  void source_dropped(const std::string& why);
  void watch_arrivals();
  void hold_still();
  void settle();
  void halt();
  void stand_still();
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
  guint glance_ = 0;
  guint retry_ = 0;
  guint look_ = 0;
  guint retries_ = 0;  // since it last delivered
  PlayState state_ = PlayState::kStarting;
  std::string trouble_;
  guint steps_ = 0;            // that wait until it is paused
  bool is_moving_ = false;     // a step or a seek is under way
  guint64 frames_before_ = 0;  // the last of these
  guint64 frames_at_rewind_ = 0;
  guint64 rendered_before_ = 0;  // when it was last sent to play
  guint64 reconnections_ = 0;
  guint64 glanced_frames_ = 0;
  guint glances_without_frames_ = 0;
  bool has_begun_ = false;  // a frame has come since the source was started
};

}  // namespace live
