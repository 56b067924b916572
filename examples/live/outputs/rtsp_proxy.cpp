// SPDX-License-Identifier: MIT
#include "examples/live/outputs/rtsp_proxy.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "examples/live/http/guarded_input.hpp"
#include "examples/live/outputs/rtsp_guard.hpp"
#include "examples/live/timeouts.hpp"

namespace live {
namespace {

constexpr std::size_t kMaxClients = 40;  // more than the sessions of RtspOutput
constexpr std::ptrdiff_t kMaxClientsPerAddress = 10;
constexpr guint kMaxTicksWithoutSession = 10;
constexpr guint kMaxRtspBody = 0;  // the supported requests have no body

Ref<GInetSocketAddress> inet(GSocketAddress* address) {
  if (address == nullptr || !G_IS_INET_SOCKET_ADDRESS(address)) return nullptr;
  return Ref<GInetSocketAddress>(G_INET_SOCKET_ADDRESS(address));
}

Ref<GInetSocketAddress> remote_of(GSocket* socket) {
  return inet(g_socket_get_remote_address(socket, nullptr));
}

Ref<GInetSocketAddress> local_of(GSocket* socket) {
  return inet(g_socket_get_local_address(socket, nullptr));
}

/* Loopback socket pairs */

struct Pair {
  Ref<GSocket> ours;
  Ref<GSocket> servers;
};

Ref<GSocket> loopback_socket(GSocketFamily family) {
  return Ref<GSocket>(g_socket_new(family, G_SOCKET_TYPE_STREAM, G_SOCKET_PROTOCOL_TCP, nullptr));
}

// Skips connections of other local programs.
Ref<GSocket> accept_from(GSocket* listener, GSocket* wanted) {
  constexpr int kTries = 8;
  const Ref<GInetSocketAddress> local = local_of(wanted);
  for (int i = 0; local && i < kTries; ++i) {
    Ref<GSocket> socket(g_socket_accept(listener, nullptr, nullptr));
    const Ref<GInetSocketAddress> remote = socket ? remote_of(socket.get()) : nullptr;
    if (!remote) return nullptr;
    if (g_inet_socket_address_get_port(remote.get()) ==
        g_inet_socket_address_get_port(local.get())) {
      return socket;
    }
  }
  return nullptr;
}

// Uses the client's address family, which determines the family of the server's UDP sockets.
std::optional<Pair> make_pair(GSocketFamily family) {
  const Ref<GInetAddress> loopback(g_inet_address_new_loopback(family));
  const Ref<GSocketAddress> any_port(g_inet_socket_address_new(loopback.get(), 0));
  const Ref<GSocket> listener = loopback_socket(family);
  Pair pair{.ours = loopback_socket(family), .servers = {}};
  if (!listener || !pair.ours) return std::nullopt;
  const bool is_bound = g_socket_bind(listener.get(), any_port.get(), FALSE, nullptr) != FALSE &&
                        g_socket_listen(listener.get(), nullptr) != FALSE;
  const Ref<GSocketAddress> address(g_socket_get_local_address(listener.get(), nullptr));
  if (!is_bound || !address) return std::nullopt;
  if (!g_socket_connect(pair.ours.get(), address.get(), nullptr, nullptr)) return std::nullopt;
  pair.servers = accept_from(listener.get(), pair.ours.get());
  if (!pair.servers) return std::nullopt;
  for (GSocket* each : {pair.ours.get(), pair.servers.get()}) {
    g_socket_set_option(each, IPPROTO_TCP, TCP_NODELAY, 1, nullptr);
  }
  return pair;
}

Ref<GSocketConnection> connection_of(GSocket* socket) {
  return Ref<GSocketConnection>(g_socket_connection_factory_create_connection(socket));
}

// Forwards bytes in both directions, a few KiB at a time, until one side ends.
void relay(GSocket* client, GSocket* server, GAsyncReadyCallback on_end, gpointer data) {
  g_socket_set_option(client, IPPROTO_TCP, TCP_NODELAY, 1, nullptr);
  g_socket_set_option(client, IPPROTO_TCP, TCP_USER_TIMEOUT, kAckTimeoutMs, nullptr);
  const Ref<GSocketConnection> outside = connection_of(client);
  const Ref<GSocketConnection> inside = connection_of(server);
  const Ref<GIOStream> guarded = guard_stream(
      share(G_IO_STREAM(outside.get())),
      [guard = RtspGuard()](std::span<const guint8> bytes) mutable { return guard.take(bytes); });
  g_io_stream_splice_async(guarded.get(),
                           G_IO_STREAM(inside.get()),
                           static_cast<GIOStreamSpliceFlags>(G_IO_STREAM_SPLICE_CLOSE_STREAM1 |
                                                             G_IO_STREAM_SPLICE_CLOSE_STREAM2),
                           G_PRIORITY_DEFAULT,
                           nullptr,
                           on_end,
                           data);
}

bool has_session(GstRTSPClient* client) {
  GList* sessions = gst_rtsp_client_session_filter(client, nullptr, nullptr);
  const bool has_one = sessions != nullptr;
  g_list_free_full(sessions, g_object_unref);
  return has_one;
}

}  // namespace

RtspProxy::RtspProxy(GstRTSPServer* server) : server_(server) {
  gst_rtsp_server_set_content_length_limit(server_, kMaxRtspBody);
  GError* problem = nullptr;
  const Ref<GSocket> listener(gst_rtsp_server_create_socket(server_, nullptr, &problem));
  if (problem != nullptr) {
    const Ref<GError> error(problem);
    throw std::runtime_error(error->message);
  }
  g_signal_connect(server_, "client-connected", G_CALLBACK(on_connected), this);
  port_ = g_inet_socket_address_get_port(local_of(listener.get()).get());
  incoming_.reset(g_socket_create_source(listener.get(), G_IO_IN, nullptr));
  g_source_set_callback(incoming_.get(), G_SOURCE_FUNC(on_incoming), this, nullptr);
  g_source_attach(incoming_.get(), nullptr);
  tick_ = g_timeout_add(kTickMs, on_tick, this);
}

RtspProxy::~RtspProxy() {
  g_source_remove(tick_);
  g_source_destroy(incoming_.get());
  g_signal_handlers_disconnect_by_data(server_, this);
  const auto remove = [](GstRTSPServer*, GstRTSPClient*, gpointer) {
    return GST_RTSP_FILTER_REMOVE;
  };
  gst_rtsp_server_client_filter(server_, remove, nullptr);
}

gboolean RtspProxy::on_incoming(GSocket* listener, GIOCondition /*condition*/, gpointer data) {
  Ref<GSocket> socket(g_socket_accept(listener, nullptr, nullptr));
  if (socket) static_cast<RtspProxy*>(data)->admit(std::move(socket));
  return G_SOURCE_CONTINUE;
}

// Returning without registering the socket closes it.
void RtspProxy::admit(Ref<GSocket> socket) {
  const Ref<GInetSocketAddress> remote = remote_of(socket.get());
  GInetAddress* address = remote ? g_inet_socket_address_get_address(remote.get()) : nullptr;
  if (address == nullptr || !has_room(address)) return;
  std::optional<Pair> pair = make_pair(g_inet_address_get_family(address));
  if (!pair) return;
  const Ref<gchar> name(g_inet_address_to_string(address));
  gst_rtsp_server_transfer_connection(server_,
                                      pair->servers.release(),
                                      name.get(),
                                      g_inet_socket_address_get_port(remote.get()),
                                      nullptr);
  if (!connected_) return;
  clients_->push_back({share(socket.get()), share(address), std::move(connected_)});
  relay(socket.get(), pair->ours.get(), on_end, new Ending{clients_, std::prev(clients_->end())});
}

// No limit per loopback address: all local programs and all clients of a tunnel share it.
bool RtspProxy::has_room(GInetAddress* address) const {
  if (clients_->size() >= kMaxClients) return false;
  if (g_inet_address_get_is_loopback(address)) return true;
  return std::count_if(clients_->begin(), clients_->end(), [address](const Client& each) {
           return g_inet_address_equal(each.address.get(), address);
         }) < kMaxClientsPerAddress;
}

void RtspProxy::on_connected(GstRTSPServer* /*server*/, GstRTSPClient* client, gpointer data) {
  static_cast<RtspProxy*>(data)->connected_ = share(client);
}

// Called when either side has closed the connection or the guard has rejected the input.
void RtspProxy::on_end(GObject* /*stream*/, GAsyncResult* result, gpointer data) {
  const std::unique_ptr<Ending> ending(static_cast<Ending*>(data));
  g_io_stream_splice_finish(result, nullptr);
  ending->clients->erase(ending->client);
}

// A client that sends single bytes never reaches a timeout, so clients without a session have a
// deadline.
gboolean RtspProxy::on_tick(gpointer data) {
  for (Client& each : *static_cast<RtspProxy*>(data)->clients_) {
    each.ticks = has_session(each.rtsp.get()) ? 0 : each.ticks + 1;
    if (each.ticks > kMaxTicksWithoutSession)
      g_socket_shutdown(each.socket.get(), TRUE, TRUE, nullptr);
  }
  return G_SOURCE_CONTINUE;
}

}  // namespace live
