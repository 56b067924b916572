#pragma once  // SPDX-License-Identifier: MIT

#include <fcntl.h>
#include <glib.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "tests/gst/support.hpp"

namespace support {

/// Command lines of a shell beside this program, in a process group of their own; gone at the end.
class ShellJob {
 public:
  /// @param log  Names two files, with .out and .err behind it.
  ShellJob(const std::string& text, const std::string& folder, const std::string& log)
      : log_(folder + "/" + log) {
    process_ = fork();
    if (process_ != 0) {
      setpgid(process_, process_);  // before anybody interrupts it
      return;
    }
    setpgid(0, 0);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open((log_ + ".out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), STDOUT_FILENO);
    dup2(open((log_ + ".err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), STDERR_FILENO);
    if (chdir(folder.c_str()) != 0) _exit(126);
    execlp("bash", "bash", "-e", "-o", "pipefail", "-c", text.c_str(), nullptr);
    _exit(127);
  }
  ~ShellJob() {
    if (!is_over_) kill(-process_, SIGKILL);
    if (!is_over_) waitpid(process_, nullptr, 0);
  }
  ShellJob(const ShellJob&) = delete;
  ShellJob& operator=(const ShellJob&) = delete;

  /// What Ctrl-C sends.
  void interrupt() const { kill(-process_, SIGINT); }
  /// @return Whether it ends within three minutes, of which a busy machine may need the second.
  [[nodiscard]] bool ends() {
    for (int i = 0; i < 9000 && !is_over_; ++i) {
      is_over_ = waitpid(process_, &status_, WNOHANG) == process_;
      if (!is_over_) g_usleep(20000);
    }
    return is_over_;
  }
  /// @return Its exit status; -1 where a signal ended it, or nothing within that time.
  [[nodiscard]] int wait_for_end() {
    return ends() && WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
  }
  [[nodiscard]] std::string output() const { return contents_of(log_ + ".out"); }
  [[nodiscard]] std::string errors() const { return contents_of(log_ + ".err"); }

 private:
  std::string log_;
  pid_t process_ = -1;
  int status_ = 0;
  bool is_over_ = false;
};

/// A socket of this machine, as the kernel's tables tell of it.
struct SocketState {
  std::string here;    ///< Address and port, in hexadecimal.
  std::string there;   ///< Of the other end.
  std::string state;   ///< 01: connected; 0A: listens; 07: open, of UDP.
  std::string queues;  ///< Bytes that wait to be sent, and to be read.
};

inline std::vector<SocketState> all_sockets() {
  std::vector<SocketState> all;
  for (const char* table : {"udp", "udp6", "tcp", "tcp6"}) {
    std::ifstream in(std::string("/proc/net/") + table);
    std::string rest;
    std::getline(in, rest);  // what the columns are
    std::string number;
    SocketState one;
    while (in >> number >> one.here >> one.there >> one.state >> one.queues &&
           std::getline(in, rest)) {
      all.push_back(one);
    }
  }
  return all;
}

/// How the tables write a port, behind its address.
inline std::string port_as_shown(int port) {
  gchar* hexadecimal = g_strdup_printf(":%04X", static_cast<guint>(port));
  const std::string text = hexadecimal;
  g_free(hexadecimal);
  return text;
}

/// Whether somebody listens at a port of this machine, or is connected to it.
inline bool is_port_open(int port, bool is_connected) {
  const std::string end = port_as_shown(port);
  const std::vector<SocketState> all = all_sockets();
  return std::any_of(all.begin(), all.end(), [&](const SocketState& one) {
    return is_connected ? one.there.ends_with(end) && one.state == "01"
                        : one.here.ends_with(end) && (one.state == "0A" || one.state == "07");
  });
}

/// Whether nothing is on its way from or to a port of this machine.
inline bool is_all_read(int port) {
  const std::string end = port_as_shown(port);
  const std::vector<SocketState> all = all_sockets();
  return std::all_of(all.begin(), all.end(), [&](const SocketState& one) {
    const bool is_of_port = one.here.ends_with(end) || one.there.ends_with(end);
    return !is_of_port || one.queues == "00000000:00000000";
  });
}

}  // namespace support
