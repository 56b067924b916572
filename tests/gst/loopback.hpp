#pragma once  // SPDX-License-Identifier: MIT

#include <gio/gio.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <string>

#include "tests/gst/own_port.hpp"
#include "tests/gst/support.hpp"
#include "tests/support/child_process.hpp"

// Receivers of lines, all on the loopback interface.
namespace support {

inline std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// A socket on the loopback with a timeout.
class Socket {
 public:
  explicit Socket(GSocketType type)
      : socket_(g_socket_new(G_SOCKET_FAMILY_IPV4, type, G_SOCKET_PROTOCOL_DEFAULT, nullptr)) {
    g_socket_set_timeout(socket_, 60);
  }
  ~Socket() { g_object_unref(socket_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  /// @return The port that the system chose.
  int bind() {
    GSocketAddress* any = g_inet_socket_address_new_from_string("127.0.0.1", 0);
    g_socket_bind(socket_, any, FALSE, nullptr);
    g_object_unref(any);
    GSocketAddress* bound = g_socket_get_local_address(socket_, nullptr);
    const int port = g_inet_socket_address_get_port(G_INET_SOCKET_ADDRESS(bound));
    g_object_unref(bound);
    return port;
  }
  void connect(int port) {
    GSocketAddress* there =
        g_inet_socket_address_new_from_string("127.0.0.1", static_cast<guint>(port));
    EXPECT_TRUE(g_socket_connect(socket_, there, nullptr, nullptr));
    g_object_unref(there);
  }
  void send(const std::string& bytes) {
    g_socket_send(socket_, bytes.data(), bytes.size(), nullptr, nullptr);
  }
  void keep_little_unread() { g_socket_set_option(socket_, SOL_SOCKET, SO_RCVBUF, 4096, nullptr); }
  /// @return One datagram, or the available bytes of a stream; empty at the end or after the
  /// timeout.
  std::string receive() {
    std::array<char, 65536> bytes;
    const gssize size = g_socket_receive(socket_, bytes.data(), bytes.size(), nullptr, nullptr);
    return size > 0 ? std::string(bytes.data(), static_cast<std::size_t>(size)) : std::string();
  }
  void receive_lines(std::string& text, std::size_t count) {
    for (std::size_t lines = count_lines(text); lines < count;) {
      const std::string more = receive();
      if (more.empty()) return;
      lines += count_lines(more);
      text += more;
    }
  }

 private:
  GSocket* socket_;
};

/// tcpserversink at a port that the system chooses, with its clients.
class Server {
 public:
  explicit Server(const std::string& lines, const std::string& settings = "")
      : pipeline_(lines + "tcpserversink name=server host=127.0.0.1 port=0 sync=false " + settings),
        sink_(pipeline_.element("server")) {
    pipeline_.pause();  // frame 0 is at the sink
  }
  /// The client receives every line from now on.
  void accept(Socket& client) {
    const guint before = number("num-handles");
    client.connect(static_cast<int>(number("current-port")));
    wait_for_clients(before + 1);
  }
  [[nodiscard]] guint number(const char* property) const {
    guint value = 0;
    g_object_get(sink_.get(), property, &value, nullptr);
    return value;
  }
  void wait_for_clients(guint count) const {
    for (int i = 0; i < 6000 && number("num-handles") != count; ++i) g_usleep(10000);
    EXPECT_EQ(number("num-handles"), count);
  }
  /// Blocks this frame's line until the server has this number of clients.
  void hold(int frame, guint until_clients) {
    held_frame_ = frame;
    held_clients_ = until_clients;
    probe("server", on_line, this);
  }
  /// Probes the buffers that reach an element after frame 0.
  void probe(const char* name, GstPadProbeCallback callback, gpointer data) {
    const auto element = pipeline_.element(name);
    GstPad* pad = gst_element_get_static_pad(element.get(), "sink");
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, callback, data, nullptr);
    gst_object_unref(pad);
  }
  void play() { pipeline_.play(); }
  [[nodiscard]] std::string wait_for_end() { return pipeline_.wait_for_end(); }

 private:
  static GstPadProbeReturn on_line(GstPad*, GstPadProbeInfo*, gpointer data) {
    auto* self = static_cast<Server*>(data);
    if (++self->frame_ == self->held_frame_) self->wait_for_clients(self->held_clients_);
    return GST_PAD_PROBE_OK;
  }

  Pipeline pipeline_;
  Owned<GstElement> sink_;
  int frame_ = 0;
  int held_frame_ = 0;
  guint held_clients_ = 0;
};

/// Path of an installed program; empty if missing.
inline std::string program(const std::string& name) {
  gchar* path = g_find_program_in_path(name.c_str());
  if (path == nullptr) path = g_find_program_in_path(("/usr/sbin/" + name).c_str());
  std::string text = path != nullptr ? path : "";
  g_free(path);
  return text;
}

/// An MQTT broker on the loopback for the lifetime of this object.
class Broker {
 public:
  explicit Broker(const std::string& mosquitto)
      : process_({.arguments = {mosquitto, "-p", port()},
                  .output = silence_.number(),
                  .error = silence_.number()}) {}
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  [[nodiscard]] std::string port() const { return std::to_string(port_.number()); }
  [[nodiscard]] std::string address() const {
    return " -h 127.0.0.1 -p " + port() + " -t pad -q 1 ";
  }
  /// The broker stores messages for this reader from now on.
  [[nodiscard]] bool subscribe() const {
    for (int i = 0; i < 1200; ++i) {  // until the broker accepts connections
      if (run_reader("-E").status == 0) return true;
      g_usleep(50000);
    }
    return false;
  }
  [[nodiscard]] std::string read(std::size_t count) const {
    return run_reader("-W 60 -C " + std::to_string(count)).text;
  }

 private:
  [[nodiscard]] Outcome run_reader(const std::string& options) const {
    return run_shell("mosquitto_sub" + address() + "-i reader -c " + options + " 2> /dev/null");
  }

  const OwnPort port_;
  const Descriptor silence_{"/dev/null", O_WRONLY};
  ChildProcess process_;
};

}  // namespace support
