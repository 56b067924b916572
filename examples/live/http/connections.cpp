// SPDX-License-Identifier: MIT
#include "examples/live/http/connections.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <algorithm>

#include "examples/live/timeouts.hpp"

namespace live {
namespace {

constexpr std::size_t kMaxConnections = 160;
constexpr std::ptrdiff_t kMaxPerAddress = 40;
constexpr gint64 kRequestUs = 20 * G_USEC_PER_SEC;  // for a complete request
constexpr guint kIdleTimeoutSeconds = 20;           // without reading or writing

std::string text_of(GSocketAddress* address) {
  const Ref<gchar> text(g_socket_connectable_to_string(G_SOCKET_CONNECTABLE(address)));
  return text.get();
}

}  // namespace

Connections::Connections() : tick_(g_timeout_add(kTickMs, on_tick, this)) {}

Connections::~Connections() {
  g_source_remove(tick_);
}

bool Connections::admit(GSocketConnection* connection) {
  GSocket* socket = g_socket_connection_get_socket(connection);
  const Ref<GSocketAddress> remote(g_socket_get_remote_address(socket, nullptr));
  if (!remote || !G_IS_INET_SOCKET_ADDRESS(remote.get())) return false;
  GInetAddress* address = g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(remote.get()));
  const Ref<gchar> name(g_inet_address_to_string(address));
  if (!has_room(address, name.get())) return false;
  g_socket_set_timeout(socket, kIdleTimeoutSeconds);
  g_socket_set_option(socket, IPPROTO_TCP, TCP_NODELAY, 1, nullptr);
  g_socket_set_option(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, kAckTimeoutMs, nullptr);
  const std::string client = text_of(remote.get());
  (*open_)[client] = {share(socket), name.get(), g_get_monotonic_time() + kRequestUs};
  g_object_weak_ref(G_OBJECT(connection), on_gone, new Gone{open_, client});
  return true;
}

// No limit per loopback address: all local programs and all clients of a tunnel share it.
bool Connections::has_room(GInetAddress* address, const std::string& name) const {
  if (open_->size() >= kMaxConnections) return false;
  if (g_inet_address_get_is_loopback(address)) return true;
  return std::count_if(open_->begin(), open_->end(), [&name](const auto& each) {
           return each.second.address == name;
         }) < kMaxPerAddress;
}

GSocket* Connections::clear_deadline(GSocketAddress* client) {
  const auto found = client != nullptr ? open_->find(text_of(client)) : open_->end();
  if (found == open_->end()) return nullptr;
  found->second.deadline_us = 0;
  g_socket_set_timeout(found->second.socket.get(), kIdleTimeoutSeconds);
  return found->second.socket.get();
}

void Connections::disable_idle_timeout(GSocketAddress* client) {
  const auto found = client != nullptr ? open_->find(text_of(client)) : open_->end();
  if (found != open_->end()) g_socket_set_timeout(found->second.socket.get(), 0);
}

void Connections::on_gone(gpointer data, GObject* /*connection*/) {
  const std::unique_ptr<Gone> gone(static_cast<Gone*>(data));
  gone->open->erase(gone->client);
}

// A client that sends single bytes never reaches the idle timeout, so requests have a deadline. The
// shutdown ends libsoup's read, which closes the connection.
gboolean Connections::on_tick(gpointer data) {
  const gint64 now_us = g_get_monotonic_time();
  for (auto& [client, each] : *static_cast<Connections*>(data)->open_) {
    if (each.deadline_us == 0 || now_us < each.deadline_us) continue;
    g_socket_shutdown(each.socket.get(), TRUE, TRUE, nullptr);
    each.deadline_us = 0;
  }
  return G_SOURCE_CONTINUE;
}

}  // namespace live
