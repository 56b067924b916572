#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <string>

#include "core/scene/scene.hpp"
#include "examples/landing/camera_view.hpp"
#include "examples/landing/eye.hpp"

namespace landing {

// A method is "apriltag", "whycon", or detector and tracking of ellipsetrack: "arcs+edges".

/// Throws std::invalid_argument where a method is none of these, std::runtime_error where it is not
/// built in. What ellipsetrack has, only eye_of() knows.
void check_method(const std::string& method);

/// Lays the pad that a method can see on the ground: for apriltag and whycon their markers in place
/// of the mark inside the ring; other methods take the scene's own.
void lay_pad(const std::string& method, ellipse::Scene& scene);

/// @param pad  As lay_pad() has made it.
/// Throws as check_method(), and std::runtime_error where ellipsetrack refuses the method.
[[nodiscard]] std::unique_ptr<Eye> eye_of(const std::string& method,
                                          const Rig& rig,
                                          const ellipse::Pad& pad,
                                          int rate);

}  // namespace landing
