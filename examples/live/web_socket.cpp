// SPDX-License-Identifier: MIT
#include "examples/live/web_socket.hpp"

#include <utility>

namespace live {
namespace {

constexpr guint64 kLargestMessage = 1024;  // an acknowledgement has some 30 bytes
constexpr double kMessagesPerSecond = 250.0;
constexpr guint kKeepaliveSeconds = 20;

}  // namespace

WebSocket::WebSocket(SoupWebsocketConnection* connection, GSocket* socket)
    : connection_(share(connection)),
      socket_(share(socket)),
      allowance_(kMessagesPerSecond, 2.0 * kMessagesPerSecond) {
  soup_websocket_connection_set_max_incoming_payload_size(connection, kLargestMessage);
  soup_websocket_connection_set_keepalive_interval(connection, kKeepaliveSeconds);
  g_signal_connect(connection, "message", G_CALLBACK(on_message), this);
  g_signal_connect(connection, "closed", G_CALLBACK(on_closed), this);
}

WebSocket::~WebSocket() {
  g_signal_handlers_disconnect_by_data(connection_.get(), this);
  if (soup_websocket_connection_get_state(connection_.get()) == SOUP_WEBSOCKET_STATE_OPEN) {
    soup_websocket_connection_close(connection_.get(), SOUP_WEBSOCKET_CLOSE_GOING_AWAY, nullptr);
  }
}

bool WebSocket::can_send() const {
  return soup_websocket_connection_get_state(connection_.get()) == SOUP_WEBSOCKET_STATE_OPEN &&
         (g_socket_condition_check(socket_.get(), G_IO_OUT) & G_IO_OUT) != 0;
}

void WebSocket::send_binary(GBytes* bytes) {
  gsize size = 0;
  const gconstpointer data = g_bytes_get_data(bytes, &size);
  soup_websocket_connection_send_binary(connection_.get(), data, size);
}

void WebSocket::send_text(const char* text) {
  soup_websocket_connection_send_text(connection_.get(), text);
}

void WebSocket::close(const char* why) {
  if (soup_websocket_connection_get_state(connection_.get()) != SOUP_WEBSOCKET_STATE_OPEN) return;
  soup_websocket_connection_close(connection_.get(), SOUP_WEBSOCKET_CLOSE_POLICY_VIOLATION, why);
}

void WebSocket::on_message(SoupWebsocketConnection* /*connection*/,
                           gint type,
                           GBytes* message,
                           gpointer data) {
  auto* self = static_cast<WebSocket*>(data);
  if (!self->allowance_.take()) {
    self->close("too many messages");
    return;
  }
  if (type != SOUP_WEBSOCKET_DATA_TEXT || !self->handlers_.on_text) return;
  gsize size = 0;
  const auto* text = static_cast<const char*>(g_bytes_get_data(message, &size));
  self->handlers_.on_text(std::string_view(text, size));
}

void WebSocket::on_closed(SoupWebsocketConnection* /*connection*/, gpointer data) {
  auto* self = static_cast<WebSocket*>(data);
  const auto closed = std::move(self->handlers_.on_closed);  // outlives what it deletes
  if (closed) closed();
}

}  // namespace live
