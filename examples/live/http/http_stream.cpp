// SPDX-License-Identifier: MIT
#include "examples/live/http/http_stream.hpp"

#include <sys/socket.h>

#include <utility>

namespace live {

HttpStream::HttpStream(SoupServerMessage* message, const std::string& content_type)
    : message_(share(message)) {
  soup_server_message_set_status(message, SOUP_STATUS_OK, nullptr);
  SoupMessageHeaders* headers = soup_server_message_get_response_headers(message);
  soup_message_headers_set_encoding(headers, SOUP_ENCODING_CHUNKED);
  soup_message_headers_replace(headers, "Content-Type", content_type.c_str());
  soup_message_headers_replace(headers, "Cache-Control", "no-store");
  soup_message_body_set_accumulate(soup_server_message_get_response_body(message), FALSE);
  GSocket* socket = soup_server_message_get_socket(message);
  if (socket != nullptr) socket_ = share(socket);
  g_signal_connect(message, "wrote-chunk", G_CALLBACK(on_wrote_chunk), this);
  g_signal_connect(message, "finished", G_CALLBACK(on_finished), this);
}

HttpStream::~HttpStream() {
  g_signal_handlers_disconnect_by_data(message_.get(), this);
  if (!is_open_) return;
  soup_message_body_complete(soup_server_message_get_response_body(message_.get()));
  soup_server_message_unpause(message_.get());
}

void HttpStream::write(GBytes* bytes) {
  is_writing_ = true;
  soup_message_body_append_bytes(soup_server_message_get_response_body(message_.get()), bytes);
  soup_server_message_unpause(message_.get());
}

void HttpStream::write(const std::string& text) {
  const Ref<GBytes> bytes(g_bytes_new(text.data(), text.size()));
  write(bytes.get());
}

void HttpStream::limit_buffer(int bytes) {
  if (socket_) g_socket_set_option(socket_.get(), SOL_SOCKET, SO_SNDBUF, bytes, nullptr);
}

void HttpStream::end() {
  if (socket_) g_socket_shutdown(socket_.get(), TRUE, TRUE, nullptr);
}

void HttpStream::on_wrote_chunk(SoupServerMessage* /*message*/, gpointer data) {
  auto* self = static_cast<HttpStream*>(data);
  self->is_writing_ = false;
  if (self->handlers_.on_ready) self->handlers_.on_ready();
}

void HttpStream::on_finished(SoupServerMessage* /*message*/, gpointer data) {
  auto* self = static_cast<HttpStream*>(data);
  self->is_open_ = false;
  const auto closed = std::move(self->handlers_.on_closed);  // may delete this object
  if (closed) closed();
}

}  // namespace live
