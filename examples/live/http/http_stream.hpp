#pragma once  // SPDX-License-Identifier: MIT

#include <libsoup/soup.h>

#include <functional>
#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// An endless chunked reply. A caller that writes only when is_ready() has at most one chunk in
/// memory for a slow client. Main loop only.
class HttpStream {
 public:
  struct Handlers {
    std::function<void()> on_ready;
    std::function<void()> on_closed;  ///< Called once, as the last call. May delete the stream.
  };

  /// Starts the reply to a request.
  HttpStream(SoupServerMessage* message, const std::string& content_type);
  ~HttpStream();
  HttpStream(const HttpStream&) = delete;
  HttpStream& operator=(const HttpStream&) = delete;

  void listen(Handlers handlers) { handlers_ = std::move(handlers); }

  [[nodiscard]] bool is_ready() const { return is_open_ && !is_writing_; }
  void write(GBytes* bytes);
  void write(const std::string& text);

  /// Limits the socket's send buffer, so that a client that has stopped reading is detected soon.
  void limit_buffer(int bytes);
  /// Closes the connection and discards unsent data.
  void end();

 private:
  static void on_wrote_chunk(SoupServerMessage* message, gpointer data);
  static void on_finished(SoupServerMessage* message, gpointer data);

  Ref<SoupServerMessage> message_;
  Ref<GSocket> socket_;  // null if already closed
  Handlers handlers_;
  bool is_open_ = true;
  bool is_writing_ = false;
};

}  // namespace live
