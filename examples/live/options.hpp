#pragma once  // SPDX-License-Identifier: MIT

#include <string>

namespace live {

/// The options of the command line.
struct Options {
  std::string source = "test:approach";
  std::string fps;  ///< For a folder, see parse_rate(); empty = default.
  bool loops = false;
  unsigned port = 8080;
  std::string bind = "127.0.0.1";
  std::string token;
  int rtsp_port = -1;  ///< -1 = off, 0 = any free port.
  std::string record;  ///< File; empty = no recording.
  std::string preset;
  std::string labels;   ///< Folder; empty = no labelling.
  std::string cameras;  ///< Folder; empty = clients cannot set camera-file.
  std::string page;     ///< Folder; empty = the compiled page.
  int quality = 80;     ///< JPEG quality, 1 to 100.
  bool allows_source_change = false;
};

/// Parses the command line. Prints help or an error and exits the program where necessary.
[[nodiscard]] Options parse_options(int argc, char** argv);

}  // namespace live
