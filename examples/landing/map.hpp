#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "examples/landing/landing.hpp"

namespace landing {

/// Draws a landing from above, step by step: the platform in the centre, both paths, the camera's
/// footprint on the ground, and the height next to it.
class Map {
 public:
  static constexpr int kWidth = 480;   ///< [px]
  static constexpr int kHeight = 360;  ///< [px]

  explicit Map(const Flight& flight) : flight_(flight) {}

  /// The next picture, kWidth x kHeight, 8-bit RGB. Valid until the next call.
  const cv::Mat& draw(const Moment& moment);

 private:
  [[nodiscard]] cv::Point at(const Eigen::Vector2d& point) const;
  void draw_grid();
  void draw_ways();
  void draw_footprint(const Moment& moment);
  void draw_platform(const Moment& moment);
  void draw_vehicle(const Moment& moment);
  void draw_height(const Moment& moment);
  void write_figures(const Moment& moment);
  void write(const std::string& text, int x, int y, double size, const cv::Scalar& colour);

  const Flight& flight_;
  Eigen::Vector2d middle_{0.0, 0.0};  // centre of the map, in the world
  std::vector<Eigen::Vector2d> platform_way_;
  std::vector<Eigen::Vector2d> vehicle_way_;
  std::vector<bool> was_seen_;
  cv::Mat canvas_;  // supersampled, for smooth lines
  cv::Mat shown_;
};

}  // namespace landing
