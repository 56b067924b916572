// SPDX-License-Identifier: MIT
#include "examples/live/outputs/video_feed.hpp"

#include <algorithm>
#include <charconv>
#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "examples/live/timeouts.hpp"

namespace live {
namespace {

constexpr gint64 kRepeatUs = 500 * 1000;
constexpr std::size_t kMaxDelays = 256;
constexpr std::size_t kMaxInFlight = 2;  // one in transit, one being painted
constexpr char kBoundary[] = "ellipse-frame";

// Parses {"ack":123}.
bool parse_ack(std::string_view text, guint64& pts) {
  constexpr std::string_view kStart = "{\"ack\":";
  if (!text.starts_with(kStart) || !text.ends_with('}')) return false;
  const char* end = text.data() + text.size() - 1;
  const auto result = std::from_chars(text.data() + kStart.size(), end, pts);
  return result.ec == std::errc{} && result.ptr == end;
}

class SocketViewer : public Viewer {
 public:
  SocketViewer(std::unique_ptr<WebSocket> socket,
               std::function<void(gint64 delay_us)> on_painted,
               std::function<void()> on_closed)
      : socket_(std::move(socket)), on_painted_(std::move(on_painted)) {
    socket_->listen({[this](std::string_view text) { take_ack(text); }, std::move(on_closed)});
  }

  [[nodiscard]] bool is_ready() const override {
    return in_flight_.size() < kMaxInFlight && socket_->can_send();
  }

  void send(const Picture& picture) override {
    if (in_flight_.empty()) waiting_since_us_ = g_get_monotonic_time();
    in_flight_.push_back({picture.pts, picture.arrived_us});
    socket_->send_binary(picture.stamped.get());
  }

  void tick(const Picture& /*newest*/) override {
    if (in_flight_.empty() || g_get_monotonic_time() - waiting_since_us_ < kStallTimeoutUs) return;
    socket_->close("no acknowledgement");
  }

 private:
  struct Sent {
    GstClockTime pts;
    gint64 arrived_us;
  };

  void take_ack(std::string_view text) {
    guint64 pts = 0;
    if (!parse_ack(text, pts)) return;
    const auto acknowledged = std::find_if(
        in_flight_.begin(), in_flight_.end(), [pts](const Sent& sent) { return sent.pts == pts; });
    if (acknowledged == in_flight_.end()) return;
    const gint64 delay_us = g_get_monotonic_time() - acknowledged->arrived_us;
    in_flight_.erase(in_flight_.begin(), acknowledged + 1);
    waiting_since_us_ = g_get_monotonic_time();
    on_painted_(delay_us);
  }

  std::unique_ptr<WebSocket> socket_;
  std::function<void(gint64)> on_painted_;
  std::deque<Sent> in_flight_;
  gint64 waiting_since_us_ = 0;
};

// A browser shows a picture only when the next part begins, so a picture without a successor is
// sent twice. Repeats the last picture when there are no frames, because only a write detects a
// disconnected client.
class StreamViewer : public Viewer {
 public:
  StreamViewer(SoupServerMessage* request,
               std::function<void()> on_ready,
               std::function<void()> on_closed)
      : stream_(request, std::string("multipart/x-mixed-replace; boundary=") + kBoundary) {
    stream_.listen({std::move(on_ready), std::move(on_closed)});
  }

  [[nodiscard]] bool is_ready() const override { return stream_.is_ready(); }

  void send(const Picture& picture) override {
    const std::string part = part_of(picture);
    write(is_first_ ? part + part : part);
    has_second_ = is_first_;
    is_first_ = false;
  }

  void tick(const Picture& picture) override {
    const gint64 quiet_us = g_get_monotonic_time() - written_us_;
    if (!is_ready() && quiet_us > kStallTimeoutUs) stream_.end();
    if (!is_ready() || quiet_us < (has_second_ ? kKeepaliveUs : kRepeatUs)) return;
    if (is_first_) {
      write("\r\n");  // a preamble may precede the first part
    } else if (last == picture.number) {
      write(part_of(picture));
    }
    has_second_ = true;
  }

 private:
  static std::string part_of(const Picture& picture) {
    const gsize size = g_bytes_get_size(picture.jpeg.get());
    std::string part = std::string("--") + kBoundary +
                       "\r\nContent-Type: image/jpeg\r\nX-PTS: " + std::to_string(picture.pts) +
                       "\r\nContent-Length: " + std::to_string(size) + "\r\n\r\n";
    part.append(static_cast<const char*>(g_bytes_get_data(picture.jpeg.get(), nullptr)), size);
    part += "\r\n";
    return part;
  }

  void write(const std::string& text) {
    stream_.write(text);
    written_us_ = g_get_monotonic_time();
  }

  HttpStream stream_;
  gint64 written_us_ = g_get_monotonic_time();
  bool is_first_ = true;
  bool has_second_ = false;  // the last part was sent twice
};

}  // namespace

VideoFeed::VideoFeed(FrameStore& store, int quality)
    : store_(store),
      encoder_(quality, [this](Picture picture) { deliver(std::move(picture)); }),
      tick_(g_timeout_add(kTickMs, on_tick, this)) {}

VideoFeed::~VideoFeed() {
  g_source_remove(tick_);
}

void VideoFeed::add(std::unique_ptr<WebSocket> socket) {
  auto& slot = viewers_.emplace_back();
  const auto on_closed = [this, &slot] { remove(slot.get()); };
  slot = std::make_unique<SocketViewer>(
      std::move(socket),
      [this](gint64 delay_us) {
        add_paint_delay(delay_us);
        update();
      },
      on_closed);
  update();
}

void VideoFeed::add_stream(SoupServerMessage* request) {
  auto& slot = viewers_.emplace_back();
  const auto on_closed = [this, &slot] { remove(slot.get()); };
  slot = std::make_unique<StreamViewer>(
      request, [this] { update(); }, on_closed);
  update();
}

void VideoFeed::add_paint_delay(gint64 delay_us) {
  if (paint_delays_.size() == kMaxDelays) paint_delays_.pop_front();
  paint_delays_.push_back(static_cast<GstClockTime>(delay_us) * GST_USECOND);
}

GstClockTime VideoFeed::paint_delay(double share) const {
  if (paint_delays_.empty()) return GST_CLOCK_TIME_NONE;
  std::vector<GstClockTime> delays(paint_delays_.begin(), paint_delays_.end());
  const auto index = static_cast<std::ptrdiff_t>(share * static_cast<double>(delays.size() - 1));
  std::nth_element(delays.begin(), delays.begin() + index, delays.end());
  return delays[static_cast<std::size_t>(index)];
}

void VideoFeed::remove(const Viewer* viewer) {
  viewers_.remove_if([viewer](const auto& each) { return each.get() == viewer; });
}

void VideoFeed::send(Viewer& viewer) {
  viewer.last = picture_.number;
  viewer.send(picture_);
  ++sent_;
  sent_bytes_ += g_bytes_get_size(picture_.jpeg.get());
}

void VideoFeed::update() {
  const FramePtr newest = store_.newest();
  if (!newest) return;
  const bool is_current = picture_.jpeg && picture_.number == newest->number;
  bool is_wanted = false;
  for (const auto& viewer : viewers_) {
    if (viewer->last == newest->number || !viewer->is_ready()) continue;
    if (is_current) send(*viewer);
    is_wanted = true;
  }
  if (is_wanted && !is_current && !encoder_.is_busy()) encoder_.encode(newest);
}

// Sends the picture even if a newer frame exists, which is not encoded yet.
void VideoFeed::deliver(Picture picture) {
  picture_ = std::move(picture);
  for (const auto& viewer : viewers_) {
    if (viewer->last != picture_.number && viewer->is_ready()) send(*viewer);
  }
  update();
}

gboolean VideoFeed::on_tick(gpointer data) {
  auto* self = static_cast<VideoFeed*>(data);
  for (const auto& viewer : self->viewers_) viewer->tick(self->picture_);
  self->update();
  return G_SOURCE_CONTINUE;
}

}  // namespace live
