#pragma once  // SPDX-License-Identifier: MIT

#include "core/camera/camera.hpp"

namespace support {

/// A rational lens with tangential distortion, 58 degrees wide; the pixels are not exactly square.
inline ellipse::Camera wide() {
  ellipse::Camera camera = ellipse::Camera::with_hfov(1.012, 640, 360);
  camera.fy = 1.01 * camera.fx;
  camera.distortion = {-0.22, 0.05, 0.001, -0.0007, -0.004, 0.01, 0.002, -0.001};
  return camera;
}

/// A fisheye of some 115 degrees, with its principal point off the picture's centre.
inline ellipse::Camera fisheye() {
  ellipse::Camera camera;
  camera.width = 640;
  camera.height = 360;
  camera.fx = camera.fy = 305.0;
  camera.cx = 321.0;
  camera.cy = 178.5;
  camera.lens = ellipse::LensModel::kFisheye;
  camera.distortion = {-0.02, 0.004, -0.002, 0.0003};
  return camera;
}

}  // namespace support
