#pragma once  // SPDX-License-Identifier: MIT

#include <memory>

#include "core/camera/camera.hpp"
#include "core/scene/pad.hpp"
#include "core/scene/sheet.hpp"
#include "examples/landing/peer_eye.hpp"

namespace landing {

/// Whether this build includes the apriltag library. Without it, the functions below throw
/// std::runtime_error.
[[nodiscard]] bool has_apriltag();

/// The tag painted inside a pad's ring: number 0 of the family tag36h11, as large as fits with a
/// white border of one cell.
/// @throws std::invalid_argument if the pad has no ring.
[[nodiscard]] ellipse::Sheet tag_sheet(const ellipse::Pad& pad);

/// Locates that tag with the library's detector at full resolution, and computes the position from
/// the four corners.
/// @param radius  Of the pad [m].
[[nodiscard]] std::unique_ptr<Peer> make_apriltag(const ellipse::Camera& camera,
                                                  const ellipse::Pad& pad,
                                                  double radius);

}  // namespace landing
