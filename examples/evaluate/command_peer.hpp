#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/detection/detector.hpp"

namespace evaluate {

/// Another program's answer for one image.
struct PeerAnswer {
  double ms = 0.0;                             ///< Processing time as reported by the program.
  std::vector<ellipse::Detection> detections;  ///< Scored by perimeter.
};

/// Runs another program as a peer. The command is split into words by shell rules, but without a
/// shell. The program reads one image path per line from its standard input. It writes one line per
/// image, in any order and at any time until it exits:
///
///     {"image":"the path as given","ms":12.5,"ellipses":[[cx,cy,a,b,angle],...]}
///
/// Lengths are in pixels. The semi-axes may be in either order; the angle [rad] is that of the axis
/// a. Empty lines are ignored. Standard error is inherited.
///
/// Blocks until the program exits. Not thread-safe: SIGPIPE is ignored during the call. The program
/// runs in its own process group, so Ctrl-C reaches only this one.
///
/// @param is_wanted  Called from another thread ten times a second. If it returns false, the
/// program is killed and the call throws.
/// @return The answers by path. An image without an answer has no entry.
///
/// Throws std::runtime_error that names the command if it cannot be started, exits with a status
/// other than 0 or by a signal, or writes an invalid line, an image that was not requested, or an
/// image twice.
[[nodiscard]] std::map<std::string, PeerAnswer> run_command_peer(
    const std::string& command,
    std::span<const std::filesystem::path> images,
    const std::function<bool()>& is_wanted = [] { return true; });

}  // namespace evaluate
