#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "core/camera/camera.hpp"

namespace ellipse {

/// Reads a camera calibration: OpenCV's cv::FileStorage format (YAML, XML or JSON: camera_matrix,
/// distortion_coefficients, image_width, image_height, fisheye_model), a ROS camera_info YAML (the
/// same names, distortion_model plumb_bob, rational_polynomial, equidistant or fisheye), or the
/// message of that name as `ros2 topic echo` prints it.
///
/// Throws std::invalid_argument that names file, line and key of an error; without the line if the
/// key is missing. Also rejects focal lengths below 1 px, and lenses that are not one to one over
/// the middle half of the picture. Allocates; reads only regular files of at most 1 MB, so it does
/// not block.
[[nodiscard]] Camera read_camera(const std::string& path);

}  // namespace ellipse
