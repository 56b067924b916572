#pragma once  // SPDX-License-Identifier: MIT

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace programs {

struct Outcome {
  int status = -1;
  std::string text;  // standard output and standard error
};

/// Runs a command line of the shell to its end.
inline Outcome run(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen(("{ " + command + "; } 2>&1 < /dev/null").c_str(), "r");
  std::array<char, 4096> block{};
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe)) {
    outcome.text.append(block.data(), n);
  }
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

}  // namespace programs
