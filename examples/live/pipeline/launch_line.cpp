// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/launch_line.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "examples/live/ref.hpp"

namespace live {
namespace {

// Quotes each word for the shell where necessary.
std::string for_shell(const std::string& description) {
  std::istringstream words(description);
  std::string line;
  for (std::string word; words >> word;) {
    const bool is_plain = word == "!" || std::all_of(word.begin(), word.end(), [](unsigned char c) {
                            return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '=' ||
                                   c == '.' || c == '/' || c == ':' || c == ',' || c == '+';
                          });
    const Ref<gchar> quoted(g_shell_quote(word.c_str()));
    if (!line.empty()) line += ' ';
    line += is_plain ? word : std::string(quoted.get());
  }
  return line;
}

}  // namespace

std::string launch_line(const SourceSpec& source, const Properties& properties) {
  const std::string& video = source.launch.empty() ? source.description : source.launch;
  const std::string line =
      "gst-launch-1.0 " +
      for_shell(video + " ! videoconvert ! ellipsetrack" + properties.launch_settings() +
                " ! ellipseoverlay ! videoconvert ! autovideosink");
  // Runs in a subshell, because the preparation changes the working directory.
  return source.preparation.empty() ? line + "\n"
                                    : "(" + source.preparation + " && " + line + ")\n";
}

}  // namespace live
