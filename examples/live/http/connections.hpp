#pragma once  // SPDX-License-Identifier: MIT

#include <gio/gio.h>

#include <map>
#include <memory>
#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// Tracks the open connections of a server. Limits their number and the time for a request. Main
/// loop only.
class Connections {
 public:
  Connections();
  ~Connections();
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  /// Registers a connection until it is destroyed. @return false if the total limit, or that of its
  /// remote address, is reached.
  bool admit(GSocketConnection* connection);

  /// Removes the deadline of a client whose request is complete. @return Its socket; null if it is
  /// gone.
  GSocket* clear_deadline(GSocketAddress* client);

  /// Disables a client's idle timeout. Must be called before a WebSocket starts to read: a
  /// pending read keeps the timeout that it started with.
  void disable_idle_timeout(GSocketAddress* client);

  [[nodiscard]] std::size_t size() const { return open_->size(); }

 private:
  struct Open {
    Ref<GSocket> socket;
    std::string address;     // without the port
    gint64 deadline_us = 0;  // 0 = none
  };
  using ByClient = std::map<std::string, Open>;  // address and port
  // Unregisters a connection when it is destroyed, which can be after the Connections object.
  struct Gone {
    std::shared_ptr<ByClient> open;
    std::string client;
  };

  static void on_gone(gpointer data, GObject* connection);
  static gboolean on_tick(gpointer data);
  [[nodiscard]] bool has_room(GInetAddress* address, const std::string& name) const;

  std::shared_ptr<ByClient> open_ = std::make_shared<ByClient>();
  guint tick_;
};

}  // namespace live
