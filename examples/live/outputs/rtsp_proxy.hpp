#pragma once  // SPDX-License-Identifier: MIT

#include <gst/rtsp-server/rtsp-server.h>

#include <list>
#include <memory>

#include "examples/live/ref.hpp"

namespace live {

/// Accepts the clients of an RTSP server. It limits their number, passes their input through an
/// RtspGuard, and disconnects clients that set up no session, which requires the password.
///
/// gst-rtsp-server reads from sockets only, without a limit on input. A client's bytes are
/// therefore forwarded over a loopback connection within the process. Main loop only.
class RtspProxy {
 public:
  /// Listens on the server's address and port. Throws std::runtime_error if it cannot.
  /// @param server  Borrowed; must outlive this object. Must not be attached to a main context.
  explicit RtspProxy(GstRTSPServer* server);
  ~RtspProxy();
  RtspProxy(const RtspProxy&) = delete;
  RtspProxy& operator=(const RtspProxy&) = delete;

  [[nodiscard]] int port() const { return port_; }

 private:
  struct Client {
    Ref<GSocket> socket;
    Ref<GInetAddress> address;
    Ref<GstRTSPClient> rtsp;  // the server's client object
    guint ticks = 0;          // seconds without a session
  };
  using Clients = std::list<Client>;
  // Unregisters a client when its relay ends, which can be after the RtspProxy.
  struct Ending {
    std::shared_ptr<Clients> clients;
    Clients::iterator client;
  };

  static gboolean on_incoming(GSocket* listener, GIOCondition condition, gpointer data);
  static void on_connected(GstRTSPServer* server, GstRTSPClient* client, gpointer data);
  static void on_end(GObject* stream, GAsyncResult* result, gpointer data);
  static gboolean on_tick(gpointer data);
  void admit(Ref<GSocket> socket);
  [[nodiscard]] bool has_room(GInetAddress* address) const;

  GstRTSPServer* server_;
  std::shared_ptr<Clients> clients_ = std::make_shared<Clients>();
  int port_ = 0;
  Ref<GSource> incoming_;
  guint tick_ = 0;
  Ref<GstRTSPClient> connected_;  // set by on_connected()
};

}  // namespace live
