// SPDX-License-Identifier: MIT
#include "examples/live/outputs/line_feed.hpp"

#include <utility>

#include "examples/live/timeouts.hpp"

namespace live {
namespace {

constexpr std::size_t kMaxQueueLength = 30;  // 1 s of video at 30 Hz
constexpr int kBufferBytes = 32 * 1024;      // about a hundred lines

class SocketListener : public LineFeed::Listener {
 public:
  SocketListener(std::unique_ptr<WebSocket> socket, std::function<void()> on_closed)
      : socket_(std::move(socket)) {
    socket_->listen({{}, std::move(on_closed)});
    socket_->limit_buffer(kBufferBytes);
  }
  bool send(const std::string& line) override {
    if (!socket_->can_send()) return false;
    socket_->send_text(line.c_str());
    return true;
  }
  void end() override { socket_->close("too slow"); }

 private:
  std::unique_ptr<WebSocket> socket_;
};

// Sends a comment when there are no frames, because only a write detects a disconnected client.
class EventListener : public LineFeed::Listener {
 public:
  EventListener(SoupServerMessage* request,
                std::function<void()> on_ready,
                std::function<void()> on_closed)
      : stream_(request, "text/event-stream") {
    stream_.listen({std::move(on_ready), std::move(on_closed)});
    stream_.limit_buffer(kBufferBytes);
    write(": frames\n\n");
  }
  bool send(const std::string& line) override {
    if (!stream_.is_ready()) return false;
    write("data: " + line + "\n");
    return true;
  }
  void tick() override {
    if (stream_.is_ready() && g_get_monotonic_time() - written_us_ >= kKeepaliveUs) write(": \n\n");
  }
  void end() override { stream_.end(); }

 private:
  void write(const std::string& text) {
    stream_.write(text);
    written_us_ = g_get_monotonic_time();
  }

  HttpStream stream_;
  gint64 written_us_ = 0;
};

}  // namespace

LineFeed::LineFeed() : tick_(g_timeout_add(kTickMs, on_tick, this)) {}

LineFeed::~LineFeed() {
  g_source_remove(tick_);
}

void LineFeed::add(std::unique_ptr<WebSocket> socket) {
  auto& slot = listeners_.emplace_back();
  slot = std::make_unique<SocketListener>(std::move(socket), [this, &slot] { remove(slot.get()); });
  send_latest(*slot);
}

void LineFeed::add_events(SoupServerMessage* request) {
  auto& slot = listeners_.emplace_back();
  slot = std::make_unique<EventListener>(
      request, [this, &slot] { flush(*slot); }, [this, &slot] { remove(slot.get()); });
  send_latest(*slot);
}

void LineFeed::send_latest(Listener& listener) {
  if (last_.empty()) return;
  listener.queue.push_back(last_);
  flush(listener);
}

void LineFeed::remove(const Listener* listener) {
  listeners_.remove_if([listener](const auto& each) { return each.get() == listener; });
}

void LineFeed::send(const std::vector<std::string>& lines) {
  if (!lines.empty()) last_ = lines.back();
  for (const auto& listener : listeners_) {
    for (const std::string& line : lines) listener->queue.push_back(line);
    for (; listener->queue.size() > kMaxQueueLength; ++lost_) listener->queue.pop_front();
    flush(*listener);
  }
}

void LineFeed::flush(Listener& listener) {
  while (!listener.queue.empty() && listener.send(listener.queue.front())) {
    listener.queue.pop_front();
    listener.moved_us = g_get_monotonic_time();
  }
  if (listener.queue.empty()) listener.moved_us = g_get_monotonic_time();
}

gboolean LineFeed::on_tick(gpointer data) {
  auto* self = static_cast<LineFeed*>(data);
  for (const auto& listener : self->listeners_) {
    self->flush(*listener);
    if (listener->queue.empty()) listener->tick();
    if (g_get_monotonic_time() - listener->moved_us > kStallTimeoutUs) listener->end();
  }
  return G_SOURCE_CONTINUE;
}

}  // namespace live
