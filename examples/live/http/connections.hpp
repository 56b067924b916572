#pragma once  // SPDX-License-Identifier: MIT

#include <gio/gio.h>

#include <map>
#include <memory>
#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// The open connections of a server: how many there may be, and how long one may take to ask. For
/// the main loop's thread.
class Connections {
 public:
  Connections();
  ~Connections();
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  /// Takes one in until it is gone. @return false where there are too many already: of all, or of
  /// the same address in a network.
  bool admit(GSocketConnection* connection);

  /// Its request has come: from now on it may stay. @return Its socket; null where it has gone.
  GSocket* keep(GSocketAddress* client);

  /// It may send nothing for as long as it likes. To be said before a WebSocket waits for its
  /// bytes: who waits already does so for the time that was allowed before.
  void allow_silence(GSocketAddress* client);

  [[nodiscard]] std::size_t size() const { return open_->size(); }

 private:
  struct Open {
    Ref<GSocket> socket;
    std::string address;     // without the port
    gint64 deadline_us = 0;  // 0 = none
  };
  using ByClient = std::map<std::string, Open>;  // address and port
  // A connection that will be gone one day, later than this where a viewer keeps it.
  struct Gone {
    std::shared_ptr<ByClient> open;
    std::string client;
  };

  static void on_gone(gpointer data, GObject* connection);
  static gboolean on_glance(gpointer data);
  [[nodiscard]] bool has_room(GInetAddress* address, const std::string& name) const;

  std::shared_ptr<ByClient> open_ = std::make_shared<ByClient>();
  guint glance_;
};

}  // namespace live
