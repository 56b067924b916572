#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/homography.hpp"
#include "core/scene/edge.hpp"

namespace ellipse {

/// Painted pattern of a pad.
enum class Pattern {
  kRingX,     ///< A ring with a free-standing X inside.
  kRing,      ///< A ring alone.
  kDisc,      ///< A filled circle.
  kRingH,     ///< A ring with an H inside.
  kBullseye,  ///< A ring around a ring around a disc.
  kNone,      ///< No pad at all, and no plate.
};

/// A landing pad. Lengths are in units of the painted circle's radius, levels are grey levels of
/// the reflected light at gain 1.
struct Pad {
  Pattern pattern = Pattern::kRingX;
  double ring_width = 0.205;       ///< 0 to 1. Also of each of the bullseye's rings.
  double mark_length = 0.62;       ///< Half the length of the bars of X and H.
  double mark_width = 0.2;         ///< Full width of the bars of X and H.
  double plate_half_width = 1.45;  ///< The square plate under the paint; 0 = none.
  double paint_level = 55.0;
  double plate_level = 225.0;
  double rim_level = 75.0;  ///< Of the plate's painted rim.
  /// Largest smooth deviation of an edge from its circle, relative to its radius; up to 0.1.
  double deformation = 0.0;
  std::vector<double> gaps_rad;  ///< Gaps in the ring, by angle on the pad.
  double gap_width_rad = 0.1;
};

/// Radius of the next edge inside the painted circle; nullopt if the pattern has none.
[[nodiscard]] std::optional<double> inner_radius(const Pad& pad);

/// Radii of all its circular edges, from the outermost.
[[nodiscard]] std::vector<double> edge_radii(const Pad& pad);

/// A pad in a view: the share of each of its layers in a pixel.
class PadPicture {
 public:
  /// @param seed  Of the deformed outline.
  PadPicture(const Pad& pad, double blur_px, std::uint64_t seed);

  /// Sets the view. Allocates at the first call only.
  void look(const Eigen::Matrix3d& plane_from_image);

  /// Shares of the light, 0 to 1; each layer lies on the one before.
  struct Layers {
    double rim = 0.0;
    double plate = 0.0;
    double paint = 0.0;
  };

  /// @param pixel  Must see the plane's front side.
  [[nodiscard]] Layers at(const Eigen::Vector2d& pixel) const;

  /// Whether the layers are certainly constant over a block of pixels.
  /// @param center_px, half_px  The block's middle, and the distance to its farthest corner [px].
  /// @param center, half        The same on the plane.
  [[nodiscard]] bool is_uniform(const Eigen::Vector2d& center_px,
                                double half_px,
                                const Eigen::Vector2d& center,
                                double half) const;

 private:
  static constexpr int kHarmonics = 7;  // the 3rd to the 9th

  struct Wedge {
    StraightEdge left;
    StraightEdge right;
  };

  void deform_edges(std::uint64_t seed);
  [[nodiscard]] double painted(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] double mark(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] double inside(const CircularEdge& circle, const Eigen::Vector2d& pixel) const;

  Pad pad_;
  double blur_px_;
  std::array<double, kHarmonics> cosines_{};  // of the deformed outline
  std::array<double, kHarmonics> sines_{};

  Eigen::Matrix3d plane_from_image_;
  std::vector<CircularEdge> circles_;  // from the outermost; paint and gap alternate
  std::vector<Box> bars_;
  std::vector<Wedge> gaps_;
  Box rim_{};
  Box plate_{};
};

}  // namespace ellipse
