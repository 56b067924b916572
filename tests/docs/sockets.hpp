#pragma once  // SPDX-License-Identifier: MIT

#include <glib.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

namespace support {

/// A socket of this machine, from the kernel's tables.
struct SocketState {
  std::string here;    ///< Address and port, in hexadecimal.
  std::string there;   ///< The other end's.
  std::string state;   ///< 01: connected; 0A: listens; 07: open, of UDP.
  std::string queues;  ///< Bytes waiting to be sent and to be read.
};

inline std::vector<SocketState> all_sockets() {
  std::vector<SocketState> all;
  for (const char* table : {"udp", "udp6", "tcp", "tcp6"}) {
    std::ifstream in(std::string("/proc/net/") + table);
    std::string rest;
    std::getline(in, rest);  // column names
    std::string number;
    SocketState one;
    while (in >> number >> one.here >> one.there >> one.state >> one.queues &&
           std::getline(in, rest)) {
      all.push_back(one);
    }
  }
  return all;
}

/// A port as the tables write it, behind its address.
inline std::string port_as_shown(int port) {
  gchar* hexadecimal = g_strdup_printf(":%04X", static_cast<guint>(port));
  const std::string text = hexadecimal;
  g_free(hexadecimal);
  return text;
}

/// Whether a program listens at a port of this machine or is connected to it.
inline bool is_port_open(int port, bool is_connected) {
  const std::string end = port_as_shown(port);
  const std::vector<SocketState> all = all_sockets();
  return std::any_of(all.begin(), all.end(), [&](const SocketState& one) {
    return is_connected ? one.there.ends_with(end) && one.state == "01"
                        : one.here.ends_with(end) && (one.state == "0A" || one.state == "07");
  });
}

/// Whether no bytes are waiting to or from a port of this machine.
inline bool is_all_read(int port) {
  const std::string end = port_as_shown(port);
  const std::vector<SocketState> all = all_sockets();
  return std::all_of(all.begin(), all.end(), [&](const SocketState& one) {
    const bool is_of_port = one.here.ends_with(end) || one.there.ends_with(end);
    return !is_of_port || one.queues == "00000000:00000000";
  });
}

}  // namespace support
