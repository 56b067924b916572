#pragma once  // SPDX-License-Identifier: MIT

#include <libsoup/soup.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "examples/live/http/connections.hpp"
#include "examples/live/http/http_gate.hpp"
#include "examples/live/http/http_reply.hpp"
#include "examples/live/http/web_socket.hpp"
#include "examples/live/ref.hpp"

namespace live {

struct Request {
  SoupServerMessage* message;  ///< Borrowed for the call.
  std::string path;
  std::string rest;  ///< Part of the path that matched the route's "*".
  std::string body;
};

/// HTTP and WebSocket server on libsoup. Every request passes the HttpGate. Main loop only.
class HttpServer {
 public:
  struct Settings {
    std::string address = "127.0.0.1";
    guint port = 8080;  ///< 0 = any free port.
    std::string token;  ///< Empty = no token required.
  };
  struct Counters {
    guint64 requests = 0;
    guint64 refused = 0;  ///< Rejected requests and connections.
  };

  /// Throws std::runtime_error if it cannot listen on the address.
  explicit HttpServer(Settings settings);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Adds a route. The path may contain one "*", which matches one path segment. A handler's
  /// std::invalid_argument becomes status 400, any other exception 500.
  void route(const char* method, const std::string& path, std::function<Reply(const Request&)>);
  /// Adds a route that replies later or endlessly: the handler must set a status or pause the
  /// message.
  void route_open(const char* method, const std::string& path, std::function<void(const Request&)>);
  void websocket(const std::string& path, WebSocketHandler on_open);

  [[nodiscard]] guint port() const { return port_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] std::size_t connections() const { return connections_.size(); }

 private:
  struct Route {
    std::string method;
    std::string before;  // up to the "*"
    std::string after;
    bool has_rest;
    bool has_end;  // false = the handler replies later or endlessly
    std::function<void(const Request&)> handle;
  };

  static gboolean on_incoming(GSocketService* service,
                              GSocketConnection* connection,
                              GObject* source,
                              gpointer data);
  static void on_early(
      SoupServer* server, SoupServerMessage* message, const char* path, GHashTable*, gpointer data);
  static void on_request(SoupServer* server,
                         SoupServerMessage* message,
                         const char* path,
                         GHashTable* query,
                         gpointer data);

  static std::optional<std::string> rest_of(const std::string& path, const Route& route);
  void listen();
  void dispatch(SoupServerMessage* message, const std::string& path);

  Settings settings_;
  HttpGate gate_;
  Ref<SoupServer> server_;
  Ref<GSocketService> service_;
  guint port_ = 0;
  std::vector<Route> routes_;
  std::map<std::string, WebSocketHandler> websockets_;
  Counters counters_;
  Connections connections_;
};

}  // namespace live
