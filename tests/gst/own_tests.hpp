#pragma once  // SPDX-License-Identifier: MIT

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/child_process.hpp"

namespace support {

/// Runs some of this program's tests, including disabled ones, in a separate process.
/// @param before  Prefix of the command: variables, or a command that runs the program.
/// @param log     File for the output.
/// @return Whether they passed.
inline bool run_own_tests(const std::string& before,
                          const std::string& tests,
                          const std::string& log) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  // Runs programs of another architecture; meson sets it in a cross build.
  const char* emulator = std::getenv("MESON_EXE_WRAPPER");
  const std::string run = emulator != nullptr ? std::string(emulator) + " " + program : program;
  const std::string command = "GTEST_OUTPUT= " + before + " " + run +
                              " --gtest_also_run_disabled_tests --gtest_filter='" + tests + "' > " +
                              log + " 2>&1";
  return run_shell(command).status == 0;
}

}  // namespace support
