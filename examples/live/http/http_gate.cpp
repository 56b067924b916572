// SPDX-License-Identifier: MIT
#include "examples/live/http/http_gate.hpp"

#include <string_view>

#include "examples/live/http/http_reply.hpp"

namespace live {
namespace {

constexpr goffset kMaxHttpBody = 64 * 1024;
constexpr std::size_t kMaxPathLength = 1024;
constexpr gsize kMaxHeaders = 16 * 1024;
constexpr double kRequestsPerSecond = 100.0;
constexpr double kRequestsAtOnce = 300.0;
constexpr std::size_t kMaxAddresses = 1024;
constexpr char kCookie[] = "ellipse_token";

std::string header(SoupServerMessage* message, const char* name) {
  const char* value =
      soup_message_headers_get_one(soup_server_message_get_request_headers(message), name);
  return value != nullptr ? value : "";
}

bool is_write(SoupServerMessage* message) {
  const std::string method = soup_server_message_get_method(message);
  return method != "GET" && method != "HEAD";
}

gsize size_of_headers(SoupServerMessage* message) {
  SoupMessageHeadersIter iter;
  soup_message_headers_iter_init(&iter, soup_server_message_get_request_headers(message));
  const char* name = nullptr;
  const char* value = nullptr;
  gsize size = 0;
  while (soup_message_headers_iter_next(&iter, &name, &value)) {
    size += std::string_view(name).size() + std::string_view(value).size();
  }
  return size;
}

std::string cookie_of(SoupServerMessage* message) {
  const std::string cookies = "; " + header(message, "Cookie");
  const std::string start = std::string("; ") + kCookie + "=";
  const std::size_t at = cookies.find(start);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + start.size();
  return cookies.substr(begin, cookies.find(';', begin) - begin);
}

// libsoup reads a body to its end even after an error reply, and would store all of it.
void discard_body(SoupServerMessage* message) {
  soup_message_body_set_accumulate(soup_server_message_get_request_body(message), FALSE);
}

bool refuse(SoupServerMessage* message, int status, const std::string& why) {
  discard_body(message);
  answer(message, error_reply(status, why));
  return true;
}

}  // namespace

bool HttpGate::refuses(SoupServerMessage* message, const std::string& path) {
  if (!is_within_rate(message)) return refuse(message, 429, "too many requests");
  const std::string host = header(message, "Host");
  if (token_.empty() && !is_loopback_host(host)) {
    return refuse(message, 403, "the Host header does not name this machine");
  }
  if (is_foreign({host, header(message, "Origin"), header(message, "Sec-Fetch-Site")})) {
    return refuse(message, 403, "cross-site requests are rejected");
  }
  if (path.size() > kMaxPathLength) return refuse(message, 414, "path too long");
  if (size_of_headers(message) > kMaxHeaders) {
    return refuse(message, 431, "headers too large");
  }
  if (take_token_from_link(message, path)) return false;
  if (!has_token(message)) {
    soup_message_headers_replace(
        soup_server_message_get_response_headers(message), "WWW-Authenticate", "Bearer");
    return refuse(message, 401, "missing or wrong token");
  }
  SoupMessageHeaders* headers = soup_server_message_get_request_headers(message);
  const SoupEncoding encoding = soup_message_headers_get_encoding(headers);
  if (encoding == SOUP_ENCODING_CHUNKED) return refuse(message, 411, "Content-Length is required");
  const goffset length = soup_message_headers_get_content_length(headers);
  if (length > (is_write(message) ? kMaxHttpBody : 0)) {
    return refuse(message, 413, "body too large");
  }
  return false;
}

bool HttpGate::is_within_rate(SoupServerMessage* message) {
  const char* host = soup_server_message_get_remote_host(message);
  const std::string address = host != nullptr ? host : "";
  if (limiters_.size() >= kMaxAddresses) limiters_.clear();
  return limiters_.try_emplace(address, kRequestsPerSecond, kRequestsAtOnce).first->second.take();
}

bool HttpGate::has_token(SoupServerMessage* message) const {
  if (token_.empty()) return true;
  // The name of the scheme is case-insensitive [RFC 9110, section 11.1].
  constexpr std::string_view kBearer = "Bearer ";
  const std::string authorization = header(message, "Authorization");
  if (g_ascii_strncasecmp(authorization.c_str(), kBearer.data(), kBearer.size()) == 0) {
    return is_same_secret(std::string_view(authorization).substr(kBearer.size()), token_);
  }
  return is_same_secret(cookie_of(message), token_);
}

// Exchanges the token of the printed link, /?token=..., for a cookie and redirects to the plain
// address.
bool HttpGate::take_token_from_link(SoupServerMessage* message, const std::string& path) const {
  const char* query = g_uri_get_query(soup_server_message_get_uri(message));
  constexpr std::string_view kStart = "token=";
  if (token_.empty() || path != "/" || query == nullptr) return false;
  const std::string_view given = query;
  if (!given.starts_with(kStart) || !is_same_secret(given.substr(kStart.size()), token_)) {
    return false;
  }
  discard_body(message);
  soup_message_headers_replace(
      soup_server_message_get_response_headers(message),
      "Set-Cookie",
      (std::string(kCookie) + "=" + token_ + "; Path=/; HttpOnly; SameSite=Strict").c_str());
  soup_server_message_set_redirect(message, 303, "/");
  soup_message_headers_replace(
      soup_server_message_get_response_headers(message), "Connection", "close");
  return true;
}

}  // namespace live
