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
class RtspDoor {
 public:
  /// Listens on the server's address and port. Throws std::runtime_error if it cannot.
  /// @param server  Borrowed; must outlive this object. Must not be attached to a main context.
  explicit RtspDoor(GstRTSPServer* server);
  ~RtspDoor();
  RtspDoor(const RtspDoor&) = delete;
  RtspDoor& operator=(const RtspDoor&) = delete;

  [[nodiscard]] int port() const { return port_; }

 private:
  struct Visit {
    Ref<GSocket> socket;
    Ref<GInetAddress> address;
    Ref<GstRTSPClient> client;  // the server's client object
    guint glances = 0;          // seconds without a session
  };
  using Visits = std::list<Visit>;
  // Unregisters a visit when its relay ends, which can be after the RtspDoor.
  struct Ending {
    std::shared_ptr<Visits> visits;
    Visits::iterator visit;
  };

  static gboolean on_incoming(GSocket* listener, GIOCondition condition, gpointer data);
  static void on_connected(GstRTSPServer* server, GstRTSPClient* client, gpointer data);
  static void on_end(GObject* stream, GAsyncResult* result, gpointer data);
  static gboolean on_glance(gpointer data);
  void let_in(Ref<GSocket> socket);
  [[nodiscard]] bool has_room(GInetAddress* address) const;

  GstRTSPServer* server_;
  std::shared_ptr<Visits> visits_ = std::make_shared<Visits>();
  int port_ = 0;
  Ref<GSource> incoming_;
  guint glance_ = 0;
  Ref<GstRTSPClient> entering_;  // set by on_connected()
};

}  // namespace live
