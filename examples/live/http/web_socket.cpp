// SPDX-License-Identifier: MIT
#include "examples/live/http/web_socket.hpp"

#include <sys/socket.h>

#include <utility>

#include "examples/live/http/frame_guard.hpp"
#include "examples/live/http/guarded_input.hpp"

namespace live {
namespace {

constexpr guint kKeepaliveSeconds = 20;

// A handshake whose reply is being written.
struct Opening {
  Ref<GSocket> socket;
  WebSocketHandler on_open;
};

// Disables extensions: the size of a compressed message is unknown until it is decompressed.
void on_reply_written(SoupServerMessage* message, gpointer data) {
  const std::unique_ptr<Opening> opening(static_cast<Opening*>(data));
  g_signal_handlers_disconnect_by_data(message, data);
  const Ref<SoupServerMessage> kept = share(message);
  const Ref<GIOStream> stream = guard_stream(
      Ref<GIOStream>(soup_server_message_steal_connection(message)),
      [guard = FrameGuard()](std::span<const guint8> bytes) mutable { return guard.take(bytes); });
  const char* origin =
      soup_message_headers_get_one(soup_server_message_get_request_headers(message), "Origin");
  const Ref<SoupWebsocketConnection> connection(
      soup_websocket_connection_new(stream.get(),
                                    soup_server_message_get_uri(message),
                                    SOUP_WEBSOCKET_CONNECTION_SERVER,
                                    origin,
                                    nullptr,
                                    nullptr));
  opening->on_open(std::make_unique<WebSocket>(connection.get(), opening->socket.get()));
}

// Called when the client disconnects during the handshake.
void on_finished(SoupServerMessage* message, gpointer data) {
  g_signal_handlers_disconnect_by_data(message, data);
  delete static_cast<Opening*>(data);
}

}  // namespace

void open_websocket(SoupServerMessage* message, GSocket* socket, const WebSocketHandler& on_open) {
  if (!soup_websocket_server_process_handshake(message, nullptr, nullptr, nullptr, nullptr)) return;
  // Must precede the first read, because a pending read keeps the timeout that it started with.
  g_socket_set_timeout(socket, 0);
  auto* opening = new Opening{share(socket), on_open};
  g_signal_connect(message, "wrote-informational", G_CALLBACK(on_reply_written), opening);
  g_signal_connect(message, "finished", G_CALLBACK(on_finished), opening);
}

WebSocket::WebSocket(SoupWebsocketConnection* connection, GSocket* socket)
    : connection_(share(connection)), socket_(share(socket)) {
  soup_websocket_connection_set_max_incoming_payload_size(connection, FrameGuard::kMaxMessage);
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

void WebSocket::limit_buffer(int bytes) {
  g_socket_set_option(socket_.get(), SOL_SOCKET, SO_SNDBUF, bytes, nullptr);
}

void WebSocket::on_message(SoupWebsocketConnection* /*connection*/,
                           gint type,
                           GBytes* message,
                           gpointer data) {
  auto* self = static_cast<WebSocket*>(data);
  if (type != SOUP_WEBSOCKET_DATA_TEXT || !self->handlers_.on_text) return;
  gsize size = 0;
  const auto* text = static_cast<const char*>(g_bytes_get_data(message, &size));
  self->handlers_.on_text(std::string_view(text, size));
}

void WebSocket::on_closed(SoupWebsocketConnection* /*connection*/, gpointer data) {
  auto* self = static_cast<WebSocket*>(data);
  const auto closed = std::move(self->handlers_.on_closed);  // may delete this object
  if (closed) closed();
}

}  // namespace live
