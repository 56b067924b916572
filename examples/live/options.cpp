// SPDX-License-Identifier: MIT
#include "examples/live/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <stdexcept>

#include "examples/live/pipeline/source_spec.hpp"

namespace live {
namespace {

// The token is part of a cookie, a link and an RTSP URL, in which other characters are reserved.
std::string is_token(const std::string& text) {
  const bool is_plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '~' || c == '-';
  });
  return is_plain ? "" : "must consist of letters, digits and . _ ~ -";
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
  CLI::App app{"Watch, tune and stream an ellipse tracker in a browser."};
  app.name("ellipse-live");
  app.get_formatter()->column_width(34);
  app.add_option("--source",
                 options.source,
                 "test:SCENE, a file, /dev/video0, a URI, a folder of pictures, or part of a "
                 "gst-launch-1.0 line in brackets")
      ->capture_default_str();
  app.add_option("--fps",
                 options.fps,
                 "Frame rate of a folder of pictures, as 10 or 30000/1001; default: 30")
      ->check(is_rate);
  app.add_flag("--loop", options.loops, "Repeat a file when it ends");
  app.add_option("--port", options.port, "Port of the page and its API; 0 = any free port")
      ->check(CLI::Range(0U, 65535U))
      ->capture_default_str();
  app.add_option(
         "--bind", options.bind, "Address to listen on; all but loopback addresses require a token")
      ->capture_default_str();
  app.add_option(
         "--token", options.token, "Access token for clients; generated and printed if needed")
      ->check(is_token);
  app.add_option(
         "--rtsp", options.rtsp_port, "Also serve rtsp://.../live on this port; 0 = any free port")
      ->check(CLI::Range(0, 65535));
  app.add_option(
      "--record", options.record, "Record H.264 to this .mkv, and the JSON lines to an .ndjson");
  app.add_option("--preset", options.preset, "Load this preset of ellipsetrack at startup");
  app.add_option("--labels", options.labels, "Folder for the data set of labelled snapshots");
  app.add_option("--cameras",
                 options.cameras,
                 "Folder of calibration files that clients may select as camera-file")
      ->check(CLI::ExistingDirectory);
  app.add_option("--page", options.page, "Serve the page's files from this folder")
      ->check(CLI::ExistingDirectory);
  app.add_option("--quality", options.quality, "JPEG quality")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_flag("--allow-source-change",
               options.allows_source_change,
               "Let clients choose the source, and thereby run any pipeline");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

}  // namespace live
