#pragma once  // SPDX-License-Identifier: MIT

#include <memory>

#include "core/camera/camera.hpp"
#include "core/scene/pad.hpp"
#include "core/scene/sheet.hpp"
#include "examples/landing/peer_eye.hpp"

namespace landing {

/// Whether this build has the library apriltag. Where it has not, the functions below throw the
/// std::runtime_error that says so.
[[nodiscard]] bool has_apriltag();

/// The tag painted inside a pad's ring: number 0 of the family tag36h11, as large as fits there
/// with a white border one cell wide.
/// @throws std::invalid_argument where the pad has no ring.
[[nodiscard]] ellipse::Sheet tag_sheet(const ellipse::Pad& pad);

/// Locates that tag by the library's detector, at the full resolution of the picture; the
/// position is that of a square with these corners.
/// @param radius  Of the pad [m].
[[nodiscard]] std::unique_ptr<Peer> make_apriltag(const ellipse::Camera& camera,
                                                  const ellipse::Pad& pad,
                                                  double radius);

}  // namespace landing
