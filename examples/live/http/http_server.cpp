// SPDX-License-Identifier: MIT
#include "examples/live/http/http_server.hpp"

#include <stdexcept>
#include <utility>

namespace live {
namespace {

constexpr int kBacklog = 160;  // connections waiting for accept()

std::string body_of(SoupServerMessage* message) {
  const Ref<GBytes> bytes(soup_message_body_flatten(soup_server_message_get_request_body(message)));
  gsize size = 0;
  const auto* data = static_cast<const char*>(g_bytes_get_data(bytes.get(), &size));
  return data != nullptr ? std::string(data, size) : std::string();
}

// libsoup answers any number of ranges in a header, each with a copy. Replies are small, and a
// server may ignore ranges [RFC 9110, section 14.2].
void ignore_ranges(SoupServerMessage* message) {
  soup_message_headers_remove(soup_server_message_get_request_headers(message), "Range");
}

}  // namespace

HttpServer::HttpServer(Settings settings)
    : settings_(std::move(settings)),
      gate_(settings_.token),
      server_(soup_server_new("server-header", "ellipse-live", nullptr)),
      service_(g_socket_service_new()) {
  soup_server_add_handler(server_.get(), nullptr, on_request, this, nullptr);
  soup_server_add_early_handler(server_.get(), nullptr, on_early, this, nullptr);
  listen();
}

HttpServer::~HttpServer() {
  g_signal_handlers_disconnect_by_data(service_.get(), this);
  g_socket_service_stop(service_.get());
  g_socket_listener_close(G_SOCKET_LISTENER(service_.get()));
  soup_server_disconnect(server_.get());
}

void HttpServer::listen() {
  const Ref<GSocketAddress> wanted(
      g_inet_socket_address_new_from_string(settings_.address.c_str(), settings_.port));
  if (!wanted)
    throw std::runtime_error("\"" + settings_.address + "\" is not an address to listen on");
  g_socket_listener_set_backlog(G_SOCKET_LISTENER(service_.get()), kBacklog);
  GSocketAddress* effective = nullptr;
  GError* problem = nullptr;
  g_socket_listener_add_address(G_SOCKET_LISTENER(service_.get()),
                                wanted.get(),
                                G_SOCKET_TYPE_STREAM,
                                G_SOCKET_PROTOCOL_TCP,
                                nullptr,
                                &effective,
                                &problem);
  if (problem != nullptr) {
    const Ref<GError> error(problem);
    throw std::runtime_error("cannot listen on " + settings_.address + ":" +
                             std::to_string(settings_.port) + ": " + error->message);
  }
  const Ref<GSocketAddress> owned(effective);
  port_ = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(effective));
  g_signal_connect(service_.get(), "incoming", G_CALLBACK(on_incoming), this);
  g_socket_service_start(service_.get());
}

void HttpServer::route(const char* method,
                       const std::string& path,
                       std::function<Reply(const Request&)> handle) {
  route_open(method, path, [handle = std::move(handle)](const Request& request) {
    answer(request.message, handle(request));
  });
  routes_.back().has_end = true;
}

void HttpServer::route_open(const char* method,
                            const std::string& path,
                            std::function<void(const Request&)> handle) {
  const std::size_t star = path.find('*');
  const bool has_rest = star != std::string::npos;
  routes_.push_back({method,
                     path.substr(0, star),
                     has_rest ? path.substr(star + 1) : "",
                     has_rest,
                     false,
                     std::move(handle)});
}

void HttpServer::websocket(const std::string& path, WebSocketHandler on_open) {
  websockets_[path] = std::move(on_open);
}

/* Connections */

gboolean HttpServer::on_incoming(GSocketService* /*service*/,
                                 GSocketConnection* connection,
                                 GObject* /*source*/,
                                 gpointer data) {
  auto* self = static_cast<HttpServer*>(data);
  if (!self->connections_.admit(connection)) {
    ++self->counters_.refused;
    return TRUE;  // the last reference closes it
  }
  GSocket* socket = g_socket_connection_get_socket(connection);
  const Ref<GSocketAddress> local(g_socket_get_local_address(socket, nullptr));
  const Ref<GSocketAddress> remote(g_socket_get_remote_address(socket, nullptr));
  if (!local || !remote) return TRUE;
  soup_server_accept_iostream(
      self->server_.get(), G_IO_STREAM(connection), local.get(), remote.get(), nullptr);
  return TRUE;
}

/* Requests */

void HttpServer::on_early(SoupServer* /*server*/,
                          SoupServerMessage* message,
                          const char* path,
                          GHashTable* /*query*/,
                          gpointer data) {
  auto* self = static_cast<HttpServer*>(data);
  ++self->counters_.requests;
  add_policy(message);
  ignore_ranges(message);
  const bool is_refused = self->gate_.refuses(message, path);
  if (is_refused) {
    ++self->counters_.refused;
  } else if (self->websockets_.contains(path)) {
    self->connections_.disable_idle_timeout(soup_server_message_get_remote_address(message));
  }
}

void HttpServer::on_request(SoupServer* /*server*/,
                            SoupServerMessage* message,
                            const char* path,
                            GHashTable* /*query*/,
                            gpointer data) {
  auto* self = static_cast<HttpServer*>(data);
  GSocket* socket =
      self->connections_.clear_deadline(soup_server_message_get_remote_address(message));
  const auto websocket = self->websockets_.find(path);
  if (websocket == self->websockets_.end()) {
    self->dispatch(message, path);
  } else if (socket != nullptr) {
    open_websocket(message, socket, websocket->second);
  }
}

// The part of the path at the route's "*"; nullopt if the path does not match.
std::optional<std::string> HttpServer::rest_of(const std::string& path, const Route& route) {
  if (!route.has_rest) return path == route.before ? std::optional<std::string>("") : std::nullopt;
  const std::size_t around = route.before.size() + route.after.size();
  const bool fits =
      path.size() > around && path.starts_with(route.before) && path.ends_with(route.after);
  if (!fits) return std::nullopt;
  std::string rest = path.substr(route.before.size(), path.size() - around);
  return rest.find('/') == std::string::npos ? std::optional(std::move(rest)) : std::nullopt;
}

void HttpServer::dispatch(SoupServerMessage* message, const std::string& path) {
  const std::string method = soup_server_message_get_method(message);
  bool is_known = false;
  for (const Route& route : routes_) {
    const std::optional<std::string> rest = rest_of(path, route);
    if (!rest) continue;
    is_known = true;
    // A HEAD request to an endless reply would open a stream.
    const bool is_head = method == "HEAD" && route.method == "GET" && route.has_end;
    if (route.method != method && !is_head) continue;
    const Request request{
        .message = message, .path = path, .rest = *rest, .body = body_of(message)};
    try {
      route.handle(request);
    } catch (const std::invalid_argument& error) {
      answer(message, error_reply(400, error.what()));
    } catch (const std::exception& error) {
      answer(message, error_reply(500, error.what()));
    }
    return;
  }
  answer(message,
         is_known ? error_reply(405, method + " is not allowed for this path")
                  : error_reply(404, "no such path"));
}

}  // namespace live
