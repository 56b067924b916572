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

/// Sends the JSON lines of all frames to everybody who listens. Who joins gets the last one at
/// once: the next may be long in coming, where the source is paused. Each has a queue of its own,
/// from which the oldest lines are lost where it is slow. For the main loop's thread.
class LineFeed {
 public:
  LineFeed();
  ~LineFeed();
  LineFeed(const LineFeed&) = delete;
  LineFeed& operator=(const LineFeed&) = delete;

  /// One text message a line.
  void add(std::unique_ptr<WebSocket> socket);
  /// Server-sent events, one a line.
  void add_events(SoupServerMessage* request);

  void send(const std::vector<std::string>& lines);

  [[nodiscard]] std::size_t listeners() const { return listeners_.size(); }
  [[nodiscard]] guint64 lost() const { return lost_; }

  class Listener {
   public:
    virtual ~Listener() = default;
    /// @return false where it can take no more now.
    virtual bool send(const std::string& line) = 0;
    /// Closes it: it has taken nothing for too long.
    virtual void end() = 0;
    /// Once a second, where there is nothing to send.
    virtual void take_glance() {}

    std::deque<std::string> queue;
    gint64 moved_us = g_get_monotonic_time();  ///< When it last took something, or had all.
  };

 private:
  static gboolean on_glance(gpointer data);
  void greet(Listener& listener);
  void flush(Listener& listener);
  void remove(const Listener* listener);

  std::list<std::unique_ptr<Listener>> listeners_;
  std::string last_;  // the newest line; empty before the first
  guint glance_;
  guint64 lost_ = 0;
};

}  // namespace live
