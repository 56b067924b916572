#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/detection/detector.hpp"

namespace evaluate {

/// What another program said of one picture.
struct PeerAnswer {
  double ms = 0.0;                             ///< Its own account of the time that it took.
  std::vector<ellipse::Detection> detections;  ///< Scored by their perimeters.
};

/// Runs any other program as a peer. The command is split into words by the rules of the shell, but
/// no shell sees it. The program gets one image's path a line on its standard input and answers
/// with one line an image, in any order and at any time until it ends:
///
///     {"image":"the path as given","ms":12.5,"ellipses":[[cx,cy,a,b,angle],...]}
///
/// in pixels, semi-axes in either order, the angle [rad] being that of the axis a. Empty lines do
/// not count. Its standard error is passed on.
///
/// @return The answers by the paths as given. An image without an answer is not among them.
///
/// Throws std::runtime_error that names the command, where it cannot be started, ends with another
/// status than 0 or by a signal, or a line is no such answer, names an image that was not asked for
/// or names one twice. Waits until the program ends. Not thread-safe: SIGPIPE is ignored meanwhile.
/// The program is in a process group of its own: a Ctrl-C is for this one.
///
/// @param is_wanted  Asked from another thread ten times a second; false ends the program, and
/// throws.
[[nodiscard]] std::map<std::string, PeerAnswer> run_command_peer(
    const std::string& command,
    std::span<const std::filesystem::path> images,
    const std::function<bool()>& is_wanted = [] { return true; });

}  // namespace evaluate
