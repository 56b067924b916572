#pragma once  // SPDX-License-Identifier: MIT

#include <gst/rtsp-server/rtsp-server.h>

#include <list>
#include <memory>

#include "examples/live/ref.hpp"

namespace live {

/// Lets clients in to an RTSP server: so many at a time, each behind an RtspGuard, and for good
/// only those that set up a session, for which they have to know the password.
///
/// gst-rtsp-server reads from a socket alone, and has no bound on what it reads. So a client's
/// bytes are handed on to it over a connection of this process with itself. For the main loop's
/// thread.
class RtspDoor {
 public:
  /// Listens where the server is set to. Throws std::runtime_error where it cannot.
  /// @param server  Borrowed for as long as this lives; not to be attached itself.
  explicit RtspDoor(GstRTSPServer* server);
  ~RtspDoor();
  RtspDoor(const RtspDoor&) = delete;
  RtspDoor& operator=(const RtspDoor&) = delete;

  [[nodiscard]] int port() const { return port_; }

 private:
  struct Visit {
    Ref<GSocket> socket;
    Ref<GInetAddress> address;
    Ref<GstRTSPClient> client;  // as the server sees it
    guint glances = 0;          // without a session
  };
  using Visits = std::list<Visit>;
  // A visit that will be over one day, later than this where the program ends.
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
  Ref<GstRTSPClient> entering_;  // that the server has made last
};

}  // namespace live
