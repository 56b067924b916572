#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "core/camera/camera.hpp"

namespace ellipse {

/// Reads a camera's calibration: what OpenCV's programs write with cv::FileStorage (YAML, XML or
/// JSON: camera_matrix, distortion_coefficients, image_width, image_height, fisheye_model), a ROS
/// camera_info YAML (the same names, distortion_model plumb_bob, rational_polynomial, equidistant
/// or fisheye), or the message of that name as `ros2 topic echo` prints it.
///
/// Throws std::invalid_argument that names file, line and key of what is wrong; the line is left
/// out where a key is missing. Refused as well is a focal length below 1 px, and a lens that is
/// not one to one over the middle half of the picture. Allocates; takes regular files only, so
/// that it never waits, of at most 1 MB.
[[nodiscard]] Camera read_camera(const std::string& path);

}  // namespace ellipse
