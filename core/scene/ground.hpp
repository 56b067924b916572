#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/scene/ground_painting.hpp"

namespace ellipse {

struct Ground {
  GroundKind kind = GroundKind::kAsphalt;
  double level = 120.0;   ///< Mean grey level of its light at gain 1.
  double contrast = 1.0;  ///< Of its texture; 0 is plain.
  cv::Mat picture;        ///< For kPicture: 8-bit grey, shared; covers 12 x 12 radii, repeated.
};

/// The ground's texture for sampling at any distance: a tile and its mipmaps [Williams1983].
class GroundTexture {
 public:
  /// Throws std::invalid_argument if the picture is not 8-bit grey, or missing.
  GroundTexture(const Ground& ground, std::uint64_t seed);

  [[nodiscard]] bool is_plain() const { return levels_.empty(); }
  [[nodiscard]] double mean() const { return mean_; }

  /// Mipmap level for pixels that cover `extent` radii of the ground.
  [[nodiscard]] static float coarseness(double extent);

  /// The light at a point of the plane [radii]; not for a plain ground.
  [[nodiscard]] float at(float x, float y, float coarseness) const;

 private:
  std::vector<cv::Mat> levels_;  // each half the size of the one before
  cv::Mat grain_;                // added at close range
  double mean_;
  float contrast_;
  float offset_;
};

}  // namespace ellipse
