#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "tests/support/child_process.hpp"

namespace programs {

using support::Outcome;

/// Runs a command line of the shell to its end, its standard error with its standard output.
inline Outcome run(const std::string& command) {
  return support::run_shell("{ " + command + "; } 2>&1");
}

}  // namespace programs
