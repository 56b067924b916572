#pragma once  // SPDX-License-Identifier: MIT

#include <gio/gio.h>

#include <array>
#include <string>

#include "examples/live/ref.hpp"

namespace support {

/// A client that writes what no library for HTTP would. Gives up after a minute of silence.
class RawClient {
 public:
  RawClient(const std::string& address, int port)
      : socket_(g_socket_new(
            G_SOCKET_FAMILY_IPV4, G_SOCKET_TYPE_STREAM, G_SOCKET_PROTOCOL_DEFAULT, nullptr)) {
    g_socket_set_timeout(socket_.get(), 60);
    const live::Ref<GSocketAddress> there(
        g_inet_socket_address_new_from_string(address.c_str(), static_cast<guint>(port)));
    g_socket_connect(socket_.get(), there.get(), nullptr, nullptr);
  }
  explicit RawClient(int port) : RawClient("127.0.0.1", port) {}

  /// @return false where the other side takes no more.
  bool send(const std::string& bytes) const {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const gssize size =
          g_socket_send(socket_.get(), bytes.data() + sent, bytes.size() - sent, nullptr, nullptr);
      if (size <= 0) return false;
      sent += static_cast<std::size_t>(size);
    }
    return true;
  }
  /// @return What there is now, once there is something; empty where nothing more comes.
  [[nodiscard]] std::string receive() const {
    std::array<char, 4096> bytes;
    const gssize size =
        g_socket_receive(socket_.get(), bytes.data(), bytes.size(), nullptr, nullptr);
    return size > 0 ? std::string(bytes.data(), static_cast<std::size_t>(size)) : std::string();
  }

 private:
  live::Ref<GSocket> socket_;
};

}  // namespace support
