#pragma once  // SPDX-License-Identifier: MIT

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>
#include <vector>

namespace programs {

/// A program at a terminal: it shows its progress, and keys come to it as signals.
class Terminal {
 public:
  explicit Terminal(const std::vector<std::string>& arguments) {
    std::vector<char*> argv;
    for (const std::string& each : arguments) argv.push_back(const_cast<char*>(each.c_str()));
    argv.push_back(nullptr);
    process_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (process_ != 0) return;
    execv(argv.front(), argv.data());
    _exit(127);
  }
  ~Terminal() {
    if (!is_over_) kill(process_, SIGKILL);
    if (!is_over_) waitpid(process_, nullptr, 0);
    close(terminal_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// @return Whether the program has shown this before its end.
  [[nodiscard]] bool read_until(const std::string& part) {
    while (text_.find(part) == std::string::npos) {
      if (!read_some()) return false;
    }
    return true;
  }
  void type(char key) const { (void)!write(terminal_, &key, 1); }
  /// @return The exit status; -1 where a signal ended it.
  [[nodiscard]] int wait_for_end() {
    while (read_some()) continue;
    int status = 0;
    is_over_ = waitpid(process_, &status, 0) == process_;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  // Until nobody has the terminal open any more.
  bool read_some() {
    std::array<char, 4096> block{};
    const ssize_t size = read(terminal_, block.data(), block.size());
    if (size > 0) text_.append(block.data(), static_cast<std::size_t>(size));
    return size > 0;
  }

  pid_t process_ = -1;
  int terminal_ = -1;
  bool is_over_ = false;
  std::string text_;
};

}  // namespace programs
