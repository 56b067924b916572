#pragma once  // SPDX-License-Identifier: MIT

#include <libsoup/soup.h>

#include <functional>
#include <memory>
#include <string_view>

#include "examples/live/ref.hpp"

namespace live {

/// One WebSocket of a client. What is sent waits nowhere but in the socket: ask can_send() before,
/// and what is lost is lost. For the main loop's thread.
class WebSocket {
 public:
  struct Handlers {
    std::function<void(std::string_view)> on_text;
    std::function<void()> on_closed;  ///< Once, and the last call; deletes what it wants.
  };

  WebSocket(SoupWebsocketConnection* connection, GSocket* socket);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  void listen(Handlers handlers) { handlers_ = std::move(handlers); }

  /// Whether it is open and the system takes more for it now.
  [[nodiscard]] bool can_send() const;
  void send_binary(GBytes* bytes);
  void send_text(const char* text);
  void close(const char* why);
  /// How much the system may keep for a client that takes nothing, so that this shows soon.
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

/// Answers a request for a WebSocket, and hands it over once the answer is written. What the client
/// sends passes a FrameGuard. A request that is none is answered with what is wrong.
/// @param socket  The client's.
void open_websocket(SoupServerMessage* message, GSocket* socket, const WebSocketHandler& on_open);

}  // namespace live
