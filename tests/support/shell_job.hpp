#pragma once  // SPDX-License-Identifier: MIT

#include <chrono>
#include <csignal>
#include <string>

#include "tests/support/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace support {

/// A shell command line running in a process group of its own; ended with this object.
class ShellJob {
 public:
  /// @param log  Base name of two files, with suffixes .out and .err.
  ShellJob(const std::string& text,
           const std::string& folder,
           const std::string& log,
           const ProcessCalls& calls = {})
      : log_(folder + "/" + log),
        output_(log_ + ".out", O_WRONLY | O_CREAT | O_TRUNC),
        errors_(log_ + ".err", O_WRONLY | O_CREAT | O_TRUNC),
        shell_({.arguments = {"bash", "-e", "-o", "pipefail", "-c", text},
                .folder = folder,
                .output = output_.number(),
                .error = errors_.number(),
                .session = Session::kOwnGroup},
               calls) {}

  /// Sends SIGINT, as Ctrl-C does.
  void interrupt() const { shell_.signal(SIGINT); }
  /// @return Whether it ends within three minutes. A busy machine may need two.
  [[nodiscard]] bool ends() { return shell_.ends_within(std::chrono::minutes(3)); }
  /// @return Its exit status; -1 if a signal ended it or it did not end in time.
  [[nodiscard]] int wait_for_end() { return ends() ? shell_.exit_status() : -1; }
  [[nodiscard]] std::string output() const { return contents_of(log_ + ".out"); }
  [[nodiscard]] std::string errors() const { return contents_of(log_ + ".err"); }

 private:
  const std::string log_;
  const Descriptor output_;
  const Descriptor errors_;
  ChildProcess shell_;
};

}  // namespace support
