#pragma once  // SPDX-License-Identifier: MIT

#include <glib.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <string>

namespace support {

/// Whether a port is free for both TCP and UDP.
inline bool is_free(int port) {
  for (const int type : {SOCK_STREAM, SOCK_DGRAM}) {
    const int socket = ::socket(AF_INET, type | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<in_port_t>(port));
    const bool is_bound =
        bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    close(socket);
    if (!is_bound) return false;
  }
  return true;
}

/// A port for a program that starts later. It is below the system's ephemeral ports (32768 and up).
/// An abstract socket name reserves it against parallel runs of these tests for the lifetime of
/// this object.
class OwnPort {
 public:
  OwnPort() {
    for (int i = 0; i < 10'000 && number_ == 0; ++i) try_port(g_random_int_range(kFirst, kEnd));
    EXPECT_NE(number_, 0) << "no port is free";
  }
  ~OwnPort() { close(name_); }
  OwnPort(const OwnPort&) = delete;
  OwnPort& operator=(const OwnPort&) = delete;

  [[nodiscard]] int number() const { return number_; }

 private:
  static constexpr int kFirst = 20'000;
  static constexpr int kEnd = 32'000;

  void try_port(int port) {
    const std::string name = "gst-ellipse-tests-port-" + std::to_string(port);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::copy(name.begin(), name.end(), address.sun_path + 1);  // abstract: leaves no file
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const bool is_ours =
        bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0 && is_free(port);
    if (!is_ours) {
      close(socket);
      return;
    }
    name_ = socket;
    number_ = port;
  }

  int number_ = 0;
  int name_ = -1;
};

}  // namespace support
