#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <string>

#include "core/scene/scene.hpp"
#include "examples/landing/camera_view.hpp"
#include "examples/landing/eye.hpp"

namespace landing {

// A method is "apriltag", "whycon", or detector and tracking of ellipsetrack such as "arcs+edges".

/// Throws std::invalid_argument if the method has another form, std::runtime_error if it is not
/// part of this build. Names of ellipsetrack's detectors and modes are checked by eye_of() only.
void check_method(const std::string& method);

/// Puts the pad that the method requires on the ground: apriltag and whycon replace the mark inside
/// the ring by their markers; other methods keep the scene's pad.
void lay_pad(const std::string& method, ellipse::Scene& scene);

/// @param pad  From lay_pad().
/// Throws as check_method(), and std::runtime_error if ellipsetrack rejects the method.
[[nodiscard]] std::unique_ptr<Eye> eye_of(const std::string& method,
                                          const Rig& rig,
                                          const ellipse::Pad& pad,
                                          int rate);

}  // namespace landing
