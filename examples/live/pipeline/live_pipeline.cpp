// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/live_pipeline.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "examples/live/timeouts.hpp"

namespace live {
namespace {

// Ticks without a frame until a live source counts as lost. The first frame takes longer, because
// the source has to connect and wait for a key frame.
constexpr guint kMaxTicksToFirstFrame = 15;
constexpr guint kMaxTicksWithoutFrame = 5;
constexpr guint kPollMs = 2;
constexpr guint kFirstRetryMs = 500;
constexpr guint kMaxRetryMs = 5000;

GstElement* add(GstElement* pipeline, const char* factory) {
  GstElement* element = gst_element_factory_make(factory, nullptr);
  if (element == nullptr) throw std::runtime_error(std::string("no element \"") + factory + "\"");
  gst_bin_add(GST_BIN(pipeline), element);
  return element;
}

// The error text, with the name of a missing decoder if any.
std::string error_of(GstMessage* message) {
  GError* error = nullptr;
  gchar* details = nullptr;
  gst_message_parse_error(message, &error, &details);
  const Ref<GError> owned_error(error);
  const Ref<gchar> owned_details(details);
  const std::string text = error->message;
  const char* missing = details != nullptr ? std::strstr(details, "Missing ") : nullptr;
  return missing != nullptr ? text + " " + std::string(missing, std::strcspn(missing, "(\n"))
                            : text;
}

// A bin with one raw-video source pad. The pad exists before a decoder has created its own.
GstElement* source_bin(const std::string& description) {
  GError* problem = nullptr;
  GstElement* bin = gst_parse_bin_from_description_full(
      (description + " ! videoconvert name=live-source-end").c_str(),
      FALSE,
      nullptr,
      static_cast<GstParseFlags>(GST_PARSE_FLAG_FATAL_ERRORS | GST_PARSE_FLAG_PLACE_IN_BIN),
      &problem);
  if (problem != nullptr) {
    const Ref<GError> error(problem);
    throw std::runtime_error(error->message);
  }
  const Ref<GstElement> end(gst_bin_get_by_name(GST_BIN(bin), "live-source-end"));
  const Ref<GstPad> pad(gst_element_get_static_pad(end.get(), "src"));
  gst_element_add_pad(bin, gst_ghost_pad_new("src", pad.get()));
  return bin;
}

}  // namespace

const char* nick_of(PlayState state) {
  switch (state) {
    case PlayState::kStarting:
      return "starting";
    case PlayState::kPlaying:
      return "playing";
    case PlayState::kPausing:
      return "pausing";
    case PlayState::kPaused:
      return "paused";
    case PlayState::kEnded:
      return "ended";
    case PlayState::kReconnecting:
      return "reconnecting";
    case PlayState::kFailed:
      return "failed";
  }
  return "unknown";
}

LivePipeline::LivePipeline(Handlers handlers)
    : handlers_(std::move(handlers)),
      pipeline_(gst_pipeline_new("live")),
      tracker_(add(pipeline_, "ellipsetrack")),
      sink_(add(pipeline_, "appsink")),
      tap_(tracker_, GST_APP_SINK(sink_), std::move(handlers_.on_frame)) {
  gst_element_link(tracker_, sink_);
  const Ref<GstBus> bus(gst_element_get_bus(pipeline_));
  bus_watch_ = gst_bus_add_watch(bus.get(), on_message, this);
  tick_ = g_timeout_add(kTickMs, on_tick, this);
}

LivePipeline::~LivePipeline() {
  cancel_retry();
  if (poll_ != 0) g_source_remove(poll_);
  g_source_remove(tick_);
  g_source_remove(bus_watch_);
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  gst_object_unref(pipeline_);
}

/* Opening and playing the source, in the main loop */

void LivePipeline::close() {
  cancel_retry();
  stop();
}

void LivePipeline::open(SourceSpec spec, bool loops) {
  close();
  spec_ = std::move(spec);
  loops_ = loops;
  retries_ = 0;
  trouble_.clear();
  frames_at_rewind_ = tap_.frames();
  start();
}

void LivePipeline::start(GstState wanted) {
  state_ = PlayState::kStarting;
  ticks_without_frames_ = 0;
  has_begun_ = false;
  try {
    source_ = source_bin(spec_.description);
  } catch (const std::exception& error) {
    source_dropped(error.what());
    return;
  }
  gst_bin_add(GST_BIN(pipeline_), source_);
  gst_element_link(source_, tracker_);
  // Files play in real time. Cameras deliver the newest frame without waiting for its time.
  const GstStateChangeReturn paused = gst_element_set_state(pipeline_, GST_STATE_PAUSED);
  if (paused == GST_STATE_CHANGE_NO_PREROLL) spec_.is_live = true;
  g_object_set(sink_, "sync", spec_.is_live ? FALSE : TRUE, nullptr);
  if (paused == GST_STATE_CHANGE_FAILURE) return;
  state_ = wanted == GST_STATE_PLAYING ? PlayState::kPlaying : PlayState::kPausing;
  // A live source delivers its first frame only in PLAYING.
  if (spec_.is_live) gst_element_set_state(pipeline_, GST_STATE_PLAYING);
  advance();
}

void LivePipeline::stop() {
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  const Ref<GstBus> bus(gst_element_get_bus(pipeline_));
  gst_bus_set_flushing(bus.get(), TRUE);  // drop messages of the old source
  gst_bus_set_flushing(bus.get(), FALSE);
  if (source_ == nullptr) return;
  gst_element_unlink(source_, tracker_);
  gst_bin_remove(GST_BIN(pipeline_), source_);
  source_ = nullptr;
}

void LivePipeline::play() {
  if (state_ == PlayState::kEnded) rewind();
  if (state_ != PlayState::kPaused && state_ != PlayState::kPausing) return;
  steps_ = 0;
  state_ = PlayState::kPlaying;
  advance();
}

void LivePipeline::pause() {
  if (state_ != PlayState::kPlaying) return;
  begin_pause();
}

void LivePipeline::begin_pause() {
  steps_ = 0;
  state_ = PlayState::kPausing;
  advance();
}

// Advances towards the requested state, one transition at a time, each after the previous one is
// complete. GStreamer 1.22 can hang if a transition to PLAYING is reversed before it is complete. A
// sink that is paused again before it has resumed continues to play.
void LivePipeline::advance() {
  GstState now = GST_STATE_VOID_PENDING;
  if (state_ != PlayState::kPlaying && state_ != PlayState::kPausing) return;
  if (gst_element_get_state(pipeline_, &now, nullptr, 0) == GST_STATE_CHANGE_ASYNC) return;
  if (state_ == PlayState::kPlaying && now == GST_STATE_PAUSED) {
    rendered_before_ = tap_.rendered();
    gst_element_set_state(pipeline_, GST_STATE_PLAYING);
  } else if (state_ == PlayState::kPausing && now == GST_STATE_PLAYING) {
    pause_after_frame();
  } else if (state_ == PlayState::kPausing && now == GST_STATE_PAUSED) {
    finish_pause();
  }
}

// A paused sink waits for one more frame and renders it.
void LivePipeline::pause_after_frame() {
  if (tap_.rendered() == rendered_before_ && !is_at_end()) {
    if (poll_ == 0) poll_ = g_timeout_add(kPollMs, on_poll, this);
    return;
  }
  gst_element_set_state(pipeline_, GST_STATE_PAUSED);
  advance();
}

gboolean LivePipeline::on_poll(gpointer data) {
  auto* self = static_cast<LivePipeline*>(data);
  self->poll_ = 0;
  self->advance();
  return G_SOURCE_REMOVE;
}

void LivePipeline::finish_pause() {
  state_ = PlayState::kPaused;
  // A paused sink does not post EOS when a step or seek reaches the end.
  if (std::exchange(is_moving_, false) && is_at_end() && tap_.frames() == frames_before_) {
    end_of_stream();
  } else if (steps_ > 0) {
    --steps_;
    step();
  }
}

void LivePipeline::step() {
  if (state_ == PlayState::kPausing) ++steps_;
  if (state_ != PlayState::kPaused) return;
  if (is_at_end()) {
    end_of_stream();
    return;
  }
  state_ = PlayState::kPausing;
  is_moving_ = true;
  frames_before_ = tap_.frames();
  gst_element_send_event(sink_, gst_event_new_step(GST_FORMAT_BUFFERS, 1, 1.0, TRUE, FALSE));
  advance();
}

bool LivePipeline::is_at_end() const {
  return gst_app_sink_is_eos(GST_APP_SINK(sink_)) != FALSE;
}

// Leaves the source paused at the first frame.
void LivePipeline::rewind() {
  frames_at_rewind_ = tap_.frames();
  if (seek(0)) return;
  stop();
  start(GST_STATE_PAUSED);
}

bool LivePipeline::seek(GstClockTime position) {
  if (!is_seekable()) return false;
  // There is no frame at or after the duration.
  const GstClockTime length = duration();
  if (GST_CLOCK_TIME_IS_VALID(length) && length > 0) position = std::min(position, length - 1);
  is_moving_ = true;
  frames_before_ = tap_.frames();
  if (!gst_element_seek_simple(
          pipeline_,
          GST_FORMAT_TIME,
          static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | GST_SEEK_FLAG_ACCURATE),
          static_cast<gint64>(position))) {
    return false;
  }
  if (state_ != PlayState::kPlaying) begin_pause();
  return true;
}

bool LivePipeline::is_seekable() const {
  if (spec_.is_live) return false;
  GstQuery* query = gst_query_new_seeking(GST_FORMAT_TIME);
  gboolean is_seekable = FALSE;
  if (gst_element_query(pipeline_, query)) {
    gst_query_parse_seeking(query, nullptr, &is_seekable, nullptr, nullptr);
  }
  gst_query_unref(query);
  return is_seekable != FALSE;
}

GstClockTime LivePipeline::position() const {
  gint64 position = 0;
  const gboolean is_known = gst_element_query_position(pipeline_, GST_FORMAT_TIME, &position);
  return is_known ? static_cast<GstClockTime>(position) : GST_CLOCK_TIME_NONE;
}

GstClockTime LivePipeline::duration() const {
  if (spec_.is_live) return GST_CLOCK_TIME_NONE;
  gint64 duration = 0;
  const gboolean is_known = gst_element_query_duration(pipeline_, GST_FORMAT_TIME, &duration);
  return is_known ? static_cast<GstClockTime>(duration) : GST_CLOCK_TIME_NONE;
}

/* Bus messages and reconnection */

gboolean LivePipeline::on_message(GstBus* /*bus*/, GstMessage* message, gpointer data) {
  auto* self = static_cast<LivePipeline*>(data);
  switch (GST_MESSAGE_TYPE(message)) {
    case GST_MESSAGE_ERROR:
      self->source_dropped(error_of(message));
      break;
    case GST_MESSAGE_EOS:
      self->end_of_stream();
      break;
    case GST_MESSAGE_ASYNC_DONE:
    case GST_MESSAGE_STATE_CHANGED:
      self->advance();
      break;
    case GST_MESSAGE_LATENCY:
      gst_bin_recalculate_latency(GST_BIN(self->pipeline_));
      break;
    default:
      break;
  }
  return G_SOURCE_CONTINUE;
}

void LivePipeline::end_of_stream() {
  if (spec_.is_live) {
    source_dropped("the stream has ended");
    return;
  }
  const bool was_playing = state_ == PlayState::kPlaying;
  state_ = PlayState::kEnded;
  // Pauses at the end, so that a later seek shows one frame and does not resume playback.
  gst_element_set_state(pipeline_, GST_STATE_PAUSED);
  const bool has_frames = tap_.frames() != frames_at_rewind_;
  if (!loops_ || !has_frames) return;
  rewind();
  if (was_playing) play();
}

void LivePipeline::source_dropped(const std::string& why) {
  const bool is_new = why != trouble_;
  trouble_ = why;
  stop();
  frames_at_tick_ = tap_.frames();  // earlier frames do not count as recovery
  if (!spec_.is_live) {
    state_ = PlayState::kFailed;
    handlers_.on_trouble(trouble_);
    handlers_.on_failure();
    return;
  }
  if (is_new) handlers_.on_trouble(trouble_);
  state_ = PlayState::kReconnecting;
  cancel_retry();
  const guint delay = std::min(kFirstRetryMs << std::min(retries_, 8U), kMaxRetryMs);
  ++retries_;
  retry_ = g_timeout_add(delay, on_retry, this);
}

gboolean LivePipeline::on_retry(gpointer data) {
  auto* self = static_cast<LivePipeline*>(data);
  self->retry_ = 0;
  ++self->reconnections_;
  self->start();
  return G_SOURCE_REMOVE;
}

void LivePipeline::cancel_retry() {
  if (retry_ != 0) g_source_remove(retry_);
  retry_ = 0;
}

gboolean LivePipeline::on_tick(gpointer data) {
  static_cast<LivePipeline*>(data)->watch_arrivals();
  return G_SOURCE_CONTINUE;
}

// A network camera can stop sending without an error.
void LivePipeline::watch_arrivals() {
  const guint64 frames = tap_.frames();
  const bool has_arrived = frames != std::exchange(frames_at_tick_, frames);
  if (has_arrived) {
    if (!trouble_.empty()) handlers_.on_trouble("");
    trouble_.clear();
    retries_ = 0;
    ticks_without_frames_ = 0;
    has_begun_ = true;
  } else if (spec_.is_live && state_ == PlayState::kPlaying &&
             ++ticks_without_frames_ >=
                 (has_begun_ ? kMaxTicksWithoutFrame : kMaxTicksToFirstFrame)) {
    const guint seconds = ticks_without_frames_ * kTickMs / 1000;
    source_dropped("no frame for " + std::to_string(seconds) + " s");
  }
}

}  // namespace live
