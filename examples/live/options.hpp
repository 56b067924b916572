#pragma once  // SPDX-License-Identifier: MIT

#include <string>

namespace live {

/// What the command line asks for.
struct Options {
  std::string source = "test:approach";
  std::string fps;  ///< Of a folder, for parse_rate(); empty = the usual one.
  bool loops = false;
  unsigned port = 8080;
  std::string bind = "127.0.0.1";
  std::string token;
  int rtsp_port = -1;  ///< -1 = none, 0 = one that is free.
  std::string record;  ///< A file; empty = nothing is recorded.
  std::string preset;
  std::string labels;   ///< A folder; empty = nothing is labelled.
  std::string cameras;  ///< A folder; empty = clients set no camera-file.
  std::string page;     ///< A folder; empty = the page that is built in.
  int quality = 80;     ///< Of the JPEGs, 1 to 100.
  bool allows_source_change = false;
};

/// Ends the program with its help, or with what is wrong with the command line.
[[nodiscard]] Options parse_options(int argc, char** argv);

}  // namespace live
