#pragma once  // SPDX-License-Identifier: MIT

#include <libsoup/soup.h>

#include <functional>
#include <memory>
#include <string_view>

#include "examples/live/ref.hpp"

namespace live {

/// A client's WebSocket. It has no queue of its own: messages go to the socket's send buffer. Check
/// can_send() before sending. Main loop only.
class WebSocket {
 public:
  struct Handlers {
    std::function<void(std::string_view)> on_text;
    std::function<void()> on_closed;  ///< Called once, as the last call. May delete the WebSocket.
  };

  WebSocket(SoupWebsocketConnection* connection, GSocket* socket);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  void listen(Handlers handlers) { handlers_ = std::move(handlers); }

  /// Whether the WebSocket is open and its send buffer has space.
  [[nodiscard]] bool can_send() const;
  void send_binary(GBytes* bytes);
  void send_text(const char* text);
  void close(const char* why);
  /// Limits the socket's send buffer, so that a client that has stopped reading is detected soon.
  void limit_buffer(int bytes);

 private:
  static void on_message(SoupWebsocketConnection* connection,
                         gint type,
                         GBytes* message,
                         gpointer data);
  static void on_closed(SoupWebsocketConnection* connection, gpointer data);

  Ref<SoupWebsocketConnection> connection_;
  Ref<GSocket> socket_;
  Handlers handlers_;
};

using WebSocketHandler = std::function<void(std::unique_ptr<WebSocket>)>;

/// Answers a WebSocket handshake and passes the WebSocket to `on_open` once the reply is written.
/// The client's input passes a FrameGuard. An invalid handshake gets an error reply.
/// @param socket  The client's socket.
void open_websocket(SoupServerMessage* message, GSocket* socket, const WebSocketHandler& on_open);

}  // namespace live
