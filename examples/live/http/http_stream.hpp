#pragma once  // SPDX-License-Identifier: MIT

#include <libsoup/soup.h>

#include <functional>
#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// A reply without an end, written piece by piece. One piece at a time is on its way: who waits for
/// is_ready() keeps no more than that for a slow client. For the main loop's thread.
class HttpStream {
 public:
  struct Handlers {
    std::function<void()> on_ready;
    std::function<void()> on_closed;  ///< Once, and the last call; deletes what it wants.
  };

  /// Begins the reply to this request.
  HttpStream(SoupServerMessage* message, const std::string& content_type);
  ~HttpStream();
  HttpStream(const HttpStream&) = delete;
  HttpStream& operator=(const HttpStream&) = delete;

  void listen(Handlers handlers) { handlers_ = std::move(handlers); }

  [[nodiscard]] bool is_ready() const { return is_open_ && !is_writing_; }
  void write(GBytes* bytes);
  void write(const std::string& text);

  /// How much the system may keep for a client that takes nothing, so that this shows soon.
  void limit_buffer(int bytes);
  /// Ends the connection, whatever is still on its way.
  void end();

 private:
  static void on_wrote_chunk(SoupServerMessage* message, gpointer data);
  static void on_finished(SoupServerMessage* message, gpointer data);

  Ref<SoupServerMessage> message_;
  Ref<GSocket> socket_;  // null where it has gone already
  Handlers handlers_;
  bool is_open_ = true;
  bool is_writing_ = false;
};

}  // namespace live
