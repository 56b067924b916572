#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "tests/support/child_process.hpp"

namespace programs {

using support::Outcome;

/// Runs a shell command line to its end and captures its standard output and error.
inline Outcome run(const std::string& command) {
  return support::run_shell("{ " + command + "; } 2>&1");
}

}  // namespace programs
