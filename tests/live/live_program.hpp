#pragma once  // SPDX-License-Identifier: MIT

#include <gio/gio.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "examples/live/ref.hpp"
#include "tests/support/child_process.hpp"

// ellipse-live as a process of its own.
namespace support {

using live::Ref;

/// Whether the program's memory is its own: a sanitizer keeps what was freed.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kHasPlainMemory = false;
#else
inline constexpr bool kHasPlainMemory = true;
#endif

/// The program, from its start until this goes away or the tests are killed.
class LiveProgram {
 public:
  explicit LiveProgram(std::vector<std::string> arguments, bool waits = true) {
    arguments.insert(arguments.begin(), {std::getenv("ELLIPSE_LIVE"), "--port", "0"});
    process_ = start_child(arguments,
                           static_cast<GSubprocessFlags>(G_SUBPROCESS_FLAGS_STDOUT_PIPE |
                                                         G_SUBPROCESS_FLAGS_STDERR_MERGE));
    output_.reset(g_data_input_stream_new(g_subprocess_get_stdout_pipe(process_)));
    if (waits) url_ = address_in(line_with("http://"));
  }
  ~LiveProgram() {
    stop();
    EXPECT_FALSE(has_crashed()) << "ellipse-live has crashed";
    g_object_unref(process_);
  }
  LiveProgram(const LiveProgram&) = delete;
  LiveProgram& operator=(const LiveProgram&) = delete;

  /// Ends it as Ctrl-C does, or another signal. @return its exit status.
  int stop(int signal = SIGINT) {
    g_subprocess_send_signal(process_, signal);
    return wait();
  }
  int wait() {
    g_subprocess_wait(process_, nullptr, nullptr);
    return g_subprocess_get_if_exited(process_) ? g_subprocess_get_exit_status(process_) : -1;
  }
  /// The next line of its output that has this in it; empty at its end.
  std::string line_with(const std::string& part) {
    while (gchar* text = g_data_input_stream_read_line(output_.get(), nullptr, nullptr, nullptr)) {
      const Ref<gchar> line(text);
      if (std::strstr(text, part.c_str()) != nullptr) return text;
    }
    return "";
  }
  static std::string address_in(const std::string& line) {
    const std::size_t at = line.find("://");
    if (at == std::string::npos) return "";
    return line.substr(line.rfind(' ', at) + 1);
  }
  /// With the slash at its end.
  [[nodiscard]] const std::string& url() const { return url_; }
  [[nodiscard]] int port() const { return std::stoi(url_.substr(url_.rfind(':') + 1)); }
  /// What "VmRSS", its memory now, or "VmHWM", the most until now, says [KiB].
  [[nodiscard]] long memory_kib(const std::string& field) const {
    std::ifstream status(std::string("/proc/") + g_subprocess_get_identifier(process_) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with(field + ":")) return std::stol(line.substr(field.size() + 1));
    }
    return 0;
  }

 private:
  // SIGINT ends it by itself where it comes before the program has begun to listen.
  [[nodiscard]] bool has_crashed() const {
    return g_subprocess_get_if_signaled(process_) && g_subprocess_get_term_sig(process_) != SIGINT;
  }

  GSubprocess* process_;
  Ref<GDataInputStream> output_;
  std::string url_;
};

}  // namespace support
