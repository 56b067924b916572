// SPDX-License-Identifier: MIT
#include "examples/live/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <stdexcept>

#include "examples/live/source_spec.hpp"

namespace live {
namespace {

// It stands in a cookie, in a link and in the address of RTSP, where other characters mean
// something.
std::string is_token(const std::string& text) {
  const bool is_plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '~' || c == '-';
  });
  return is_plain ? "" : "takes letters, digits and . _ ~ - only";
}

std::string is_rate(const std::string& text) {
  try {
    (void)parse_rate(text);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

}  // namespace

Options parse_options(int argc, char** argv) {
  Options options;
  CLI::App app{"Watch, tune and stream an ellipse tracker from a browser."};
  app.name("ellipse-live");
  app.add_option("--source",
                 options.source,
                 "test:SCENE, a file, /dev/video0, a URI, a folder of pictures, or a piece of a "
                 "gst-launch-1.0 line in brackets")
      ->capture_default_str();
  app.add_option(
         "--fps", options.fps, "Pictures a second of a folder, as 10 or 30000/1001; 30 otherwise")
      ->check(is_rate);
  app.add_flag("--loop", options.loops, "Play a file again when it ends");
  app.add_option("--port", options.port, "Of the page and its API; 0 = a free one")
      ->check(CLI::Range(0U, 65535U))
      ->capture_default_str();
  app.add_option(
         "--bind", options.bind, "Address to listen at; any but a loopback address wants a token")
      ->capture_default_str();
  app.add_option("--token", options.token, "What clients have to know; made and printed if needed")
      ->check(is_token);
  app.add_option(
         "--rtsp", options.rtsp_port, "Also serve rtsp://.../live at this port; 0 = a free one")
      ->check(CLI::Range(0, 65535));
  app.add_option(
      "--record", options.record, "Write H.264 into this .mkv, and the JSON lines beside it");
  app.add_option("--preset", options.preset, "Begin with this preset of ellipsetrack");
  app.add_option("--labels", options.labels, "Folder for the data set of labelled snapshots");
  app.add_option("--cameras",
                 options.cameras,
                 "Folder of calibrations, from which clients may choose a camera-file")
      ->check(CLI::ExistingDirectory);
  app.add_option("--page", options.page, "Serve the page's files from this folder")
      ->check(CLI::ExistingDirectory);
  app.add_option("--quality", options.quality, "Of the JPEGs")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_flag("--allow-source-change",
               options.allows_source_change,
               "Let clients choose the source, and so run any pipeline");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

}  // namespace live
