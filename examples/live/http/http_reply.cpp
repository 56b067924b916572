// SPDX-License-Identifier: MIT
#include "examples/live/http/http_reply.hpp"

#include "examples/live/json_writer.hpp"

namespace live {

Reply error_reply(int status, const std::string& message) {
  return {.status = status, .body = error_json(message)};
}

void answer(SoupServerMessage* message, const Reply& reply) {
  soup_server_message_set_status(message, static_cast<guint>(reply.status), nullptr);
  SoupMessageHeaders* headers = soup_server_message_get_response_headers(message);
  soup_message_headers_replace(headers, "Cache-Control", "no-store");
  // libsoup keeps alive only connections that it accepted itself.
  soup_message_headers_replace(headers, "Connection", "close");
  soup_server_message_set_response(
      message, reply.type.c_str(), SOUP_MEMORY_COPY, reply.body.data(), reply.body.size());
}

void add_policy(SoupServerMessage* message) {
  SoupMessageHeaders* headers = soup_server_message_get_response_headers(message);
  soup_message_headers_replace(headers, "X-Content-Type-Options", "nosniff");
  soup_message_headers_replace(headers, "Referrer-Policy", "no-referrer");
  soup_message_headers_replace(headers, "Cross-Origin-Resource-Policy", "same-origin");
  soup_message_headers_replace(headers,
                               "Content-Security-Policy",
                               "default-src 'self'; img-src 'self' blob: data:; "
                               "frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
}

LaterReply::LaterReply(SoupServerMessage* message) : message_(share(message)) {
  soup_server_message_pause(message);
}

void LaterReply::send(const Reply& reply) {
  answer(message_.get(), reply);
  soup_server_message_unpause(message_.get());
}

}  // namespace live
