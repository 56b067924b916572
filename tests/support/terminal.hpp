#pragma once  // SPDX-License-Identifier: MIT

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/child_process.hpp"

namespace support {

struct TerminalCalls {
  int (*openpty)(int*, int*, char*, const termios*, const winsize*) = ::openpty;
  ProcessCalls process{};
};

/// Runs a program at a terminal, where it shows its progress and receives keys as signals.
///
/// A chroot or a container without /dev/pts has no pseudo terminals. Then nothing is started and
/// is_missing() returns true. Any other failure fails the test.
class Terminal {
 public:
  explicit Terminal(const std::vector<std::string>& arguments, const TerminalCalls& calls = {}) {
    int near = -1;
    int far = -1;
    if (calls.openpty(&near, &far, nullptr, nullptr, nullptr) != 0) {
      const int error = errno;
      is_missing_ = error == ENOENT || error == ENODEV || error == ENXIO || error == EIO;
      reason_ = "no pseudo terminal: " + text_of_errno(error);
      if (!is_missing_) ADD_FAILURE() << reason_;
      return;
    }
    screen_.emplace(near);
    const Descriptor end(far);  // closed here: reading ends with the last program that has it open
    program_.emplace(ChildSetup{.arguments = arguments,
                                .input = far,
                                .output = far,
                                .error = far,
                                .session = Session::kTerminal},
                     calls.process);
  }

  [[nodiscard]] bool is_missing() const { return is_missing_; }
  /// Why the terminal is missing.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  /// @return Whether the program printed this before its end.
  [[nodiscard]] bool read_until(const std::string& part) {
    while (text_.find(part) == std::string::npos) {
      if (!read_some()) return false;
    }
    return true;
  }
  void type(char key) const {
    if (screen_) (void)!write(screen_->number(), &key, 1);
  }
  /// @return The exit status; -1 if a signal ended the program or it never started.
  [[nodiscard]] int wait_for_end() {
    while (read_some()) continue;
    return program_ ? program_->wait() : -1;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  bool read_some() {
    const std::string part = screen_ ? screen_->read_some() : "";
    text_ += part;
    return !part.empty();
  }

  bool is_missing_ = false;
  std::string reason_;
  std::string text_;
  std::optional<Descriptor> screen_;
  std::optional<ChildProcess> program_;
};

}  // namespace support
