#pragma once  // SPDX-License-Identifier: MIT

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/child_process.hpp"

// Runs ellipse-live as a separate process.
namespace support {

/// Whether memory figures are those of the program: a sanitizer keeps freed memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kHasPlainMemory = false;
#else
inline constexpr bool kHasPlainMemory = true;
#endif

/// The program, running until this object is destroyed or the tests are killed. A critical message
/// of GLib ends it.
class LiveProgram {
 public:
  explicit LiveProgram(std::vector<std::string> arguments, bool waits = true)
      : process_({.arguments = command_with(std::move(arguments)),
                  .variables = {"G_DEBUG=fatal-criticals"},
                  .output = output_.in.number(),
                  .error = output_.in.number()}) {
    output_.in.close();
    if (waits) url_ = address_in(line_with("http://"));
  }
  ~LiveProgram() {
    stop();
    EXPECT_FALSE(has_crashed()) << "ellipse-live was ended by signal " << process_.ended_by();
  }
  LiveProgram(const LiveProgram&) = delete;
  LiveProgram& operator=(const LiveProgram&) = delete;

  /// Ends it with a signal, by default as Ctrl-C does. @return its exit status.
  int stop(int signal = SIGINT) {
    process_.signal(signal);
    return wait();
  }
  int wait() { return process_.wait(); }
  /// The next line of its output that contains this; empty at the end.
  std::string line_with(const std::string& part) {
    while (const auto line = next_line()) {
      if (line->find(part) != std::string::npos) return *line;
    }
    return "";
  }
  static std::string address_in(const std::string& line) {
    const std::size_t at = line.find("://");
    if (at == std::string::npos) return "";
    return line.substr(line.rfind(' ', at) + 1);
  }
  /// Ends with a slash.
  [[nodiscard]] const std::string& url() const { return url_; }
  [[nodiscard]] int port() const { return std::stoi(url_.substr(url_.rfind(':') + 1)); }
  /// A field of /proc/PID/status [KiB]: "VmRSS" is its current memory, "VmHWM" the peak.
  [[nodiscard]] long memory_kib(const std::string& field) const {
    std::ifstream status("/proc/" + id() + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with(field + ":")) return std::stol(line.substr(field.size() + 1));
    }
    return 0;
  }
  [[nodiscard]] std::string id() const { return std::to_string(process_.id()); }

 private:
  static std::vector<std::string> command_with(std::vector<std::string> arguments) {
    const char* program = std::getenv("ELLIPSE_LIVE");
    arguments.insert(arguments.begin(),
                     {program != nullptr ? program : "ellipse-live", "--port", "0"});
    return arguments;
  }
  // SIGINT may end it before its signal handler is installed.
  [[nodiscard]] bool has_crashed() const {
    return process_.ended_by() != 0 && process_.ended_by() != SIGINT;
  }
  // @return nullopt at the end of the output.
  std::optional<std::string> next_line() {
    std::size_t end = 0;
    while ((end = unread_.find('\n')) == std::string::npos) {
      const std::string more = output_.out.read_some();
      if (more.empty() && unread_.empty()) return std::nullopt;
      if (more.empty()) return std::exchange(unread_, "");
      unread_ += more;
    }
    const std::string line = unread_.substr(0, end);
    unread_.erase(0, end + 1);
    return line;
  }

  Pipe output_;
  std::string unread_;
  ChildProcess process_;
  std::string url_;
};

}  // namespace support
