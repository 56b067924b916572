#pragma once  // SPDX-License-Identifier: MIT

#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "examples/live/http/http_stream.hpp"
#include "examples/live/http/web_socket.hpp"

namespace live {

/// Sends the JSON lines of all frames to all listeners. A new listener receives the latest line
/// immediately, because a paused source sends no other. Each listener has a bounded queue that
/// drops its oldest lines. Main loop only.
class LineFeed {
 public:
  LineFeed();
  ~LineFeed();
  LineFeed(const LineFeed&) = delete;
  LineFeed& operator=(const LineFeed&) = delete;

  /// Sends one text message per line.
  void add(std::unique_ptr<WebSocket> socket);
  /// Sends one server-sent event per line.
  void add_events(SoupServerMessage* request);

  void send(const std::vector<std::string>& lines);

  [[nodiscard]] std::size_t listeners() const { return listeners_.size(); }
  [[nodiscard]] guint64 lost() const { return lost_; }

  class Listener {
   public:
    virtual ~Listener() = default;
    /// @return false if the listener cannot accept a line now.
    virtual bool send(const std::string& line) = 0;
    /// Closes a listener that has read nothing for too long.
    virtual void end() = 0;
    /// Called once a second when the queue is empty.
    virtual void tick() {}

    std::deque<std::string> queue;
    gint64 moved_us = g_get_monotonic_time();  ///< Last accepted line or empty queue.
  };

 private:
  static gboolean on_tick(gpointer data);
  void send_latest(Listener& listener);
  void flush(Listener& listener);
  void remove(const Listener* listener);

  std::list<std::unique_ptr<Listener>> listeners_;
  std::string last_;  // newest line; empty before the first one
  guint tick_;
  guint64 lost_ = 0;
};

}  // namespace live
