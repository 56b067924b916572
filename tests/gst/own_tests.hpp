#pragma once  // SPDX-License-Identifier: MIT

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace support {

/// All of a file; empty where there is none.
inline std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs some of this program's tests in a process of its own, the disabled ones among them.
/// @param before  What stands before the program: variables, or a command that takes one.
/// @param log     Takes what they print.
/// @return Whether they passed.
inline bool run_own_tests(const std::string& before,
                          const std::string& tests,
                          const std::string& log) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = "GTEST_OUTPUT= " + before + " " + program +
                              " --gtest_also_run_disabled_tests --gtest_filter='" + tests + "' > " +
                              log + " 2>&1";
  return std::system(command.c_str()) == 0;
}

}  // namespace support
