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
  std::string rest;  ///< What of the path came where the route has its "*".
  std::string body;
};

/// HTTP and WebSockets on libsoup, behind the gate that every request passes. In the main loop's
/// thread.
class HttpServer {
 public:
  struct Settings {
    std::string address = "127.0.0.1";
    guint port = 8080;  ///< 0 = one that is free.
    std::string token;  ///< Empty = none is asked for.
  };
  struct Counters {
    guint64 requests = 0;
    guint64 refused = 0;  ///< Without a right to it, too often, too much.
  };

  /// Throws std::runtime_error where it cannot listen there.
  explicit HttpServer(Settings settings);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// A path may have one "*", for one part of a path. std::invalid_argument becomes a 400.
  void route(const char* method, const std::string& path, std::function<Reply(const Request&)>);
  /// The same, for what answers later or without an end: it has to set a status or to pause.
  void route_open(const char* method, const std::string& path, std::function<void(const Request&)>);
  void websocket(const std::string& path, WebSocketHandler on_open);

  [[nodiscard]] guint port() const { return port_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }
  [[nodiscard]] std::size_t connections() const { return connections_.size(); }

 private:
  struct Route {
    std::string method;
    std::string before;  // the "*"
    std::string after;
    bool has_rest;
    bool has_end;  // of its reply
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
