#pragma once  // SPDX-License-Identifier: MIT

#include <arpa/inet.h>
#include <gio/gio.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <array>
#include <string>

#include "examples/live/ref.hpp"

namespace support {

/// A client that sends arbitrary bytes, unlike an HTTP library. Times out after a minute of
/// silence.
class RawClient {
 public:
  /// @param buffer  Receive buffer of the socket [bytes]; 0 = default.
  RawClient(const std::string& address, int port, int buffer = 0)
      : socket_(g_socket_new(
            G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_STREAM, G_SOCKET_PROTOCOL_DEFAULT, nullptr)) {
    g_socket_set_timeout(socket_.get(), 60);
    if (buffer > 0) g_socket_set_option(socket_.get(), SOL_SOCKET, SO_RCVBUF, buffer, nullptr);
    const live::Ref<GSocketAddress> there(
        g_inet_socket_address_new_from_string(address.c_str(), static_cast<guint>(port)));
    g_socket_connect(socket_.get(), there.get(), nullptr, nullptr);
  }
  explicit RawClient(int port, int buffer = 0) : RawClient("127.0.0.1", port, buffer) {}

  /// @return false if the other side accepts no more.
  bool send(const std::string& bytes) const {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const gssize size =
          g_socket_send(socket_.get(), bytes.data() + sent, bytes.size() - sent, nullptr, nullptr);
      if (size <= 0) return false;
      sent += static_cast<std::size_t>(size);
    }
    return true;
  }
  /// @return The available bytes, after waiting for some; empty at the end or after the timeout.
  [[nodiscard]] std::string receive() const {
    std::array<char, 4096> bytes;
    const gssize size =
        g_socket_receive(socket_.get(), bytes.data(), bytes.size(), nullptr, nullptr);
    return size > 0 ? std::string(bytes.data(), static_cast<std::size_t>(size)) : std::string();
  }

  /// Reads on. @return Whether the other side closed the connection rather than stayed silent.
  [[nodiscard]] bool is_ended() const {
    std::array<char, 4096> bytes;
    GError* problem = nullptr;
    gssize size = 0;
    do {
      size = g_socket_receive(socket_.get(), bytes.data(), bytes.size(), nullptr, &problem);
    } while (size > 0);
    const bool is_silent = g_error_matches(problem, G_IO_ERROR, G_IO_ERROR_TIMED_OUT);
    g_clear_error(&problem);
    return !is_silent;
  }

 private:
  live::Ref<GSocket> socket_;
};

/// An IPv4 address of this machine on a network; empty if it has none.
inline std::string network_address() {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return "";
  std::string found;
  for (const ifaddrs* each = all; each != nullptr && found.empty(); each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    if ((each->ifa_flags & IFF_LOOPBACK) != 0 || (each->ifa_flags & IFF_UP) == 0) continue;
    std::array<char, INET_ADDRSTRLEN> text;
    const auto* address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    found = inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
  }
  freeifaddrs(all);
  return found;
}

}  // namespace support
