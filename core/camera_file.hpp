#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "core/camera.hpp"

namespace ellipse {

/// Reads a camera's calibration: what OpenCV's programs write with cv::FileStorage (YAML, XML or
/// JSON: camera_matrix, distortion_coefficients, image_width, image_height, fisheye_model), or a
/// ROS camera_info YAML (the same names, distortion_model plumb_bob, rational_polynomial,
/// equidistant or fisheye).
///
/// Throws std::invalid_argument that names file, line and key of what is wrong; the line is left
/// out where a key is missing. Allocates; at most 1 MB of file.
[[nodiscard]] Camera read_camera(const std::string& path);

}  // namespace ellipse
