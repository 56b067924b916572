#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace ellipse {

/// Ground around the pad. Some kinds show shapes that resemble ellipses; only kCircles shows
/// ellipses.
enum class GroundKind {
  kPlain,
  kAsphalt,   ///< Speckled, with cracks.
  kGrass,     ///< Blades in all directions.
  kRoad,      ///< Asphalt with painted lines and arcs.
  kTiles,     ///< Square tiles with dark joints.
  kSquares,   ///< A clutter of squares.
  kFlowers,   ///< A clutter of flowers.
  kRounded,   ///< A clutter of rounded rectangles.
  kClutter,   ///< All of these clutters together, and arcs.
  kCircles,   ///< Discs, and rings less than two thirds as large as the pad.
  kGravel,    ///< Angular stones.
  kPavement,  ///< Bricks in rows.
  kFoliage,   ///< Pointed leaves over each other.
  kField,     ///< Furrows.
  kPage,      ///< Lines of straight strokes, as of print.
  kSkin,      ///< Soft, without edges.
  kPolygons,  ///< A clutter of regular polygons, of five corners and more.
  kBlades,    ///< Long bent blades over each other, with smooth edges.
  kPicture,   ///< A picture from the caller.
};

/// Width and height of the tile from draw_ground() [texels].
inline constexpr int kGroundTileSize = 1024;

/// A seamless tile of a ground: grey levels relative to the ground's mean, as floats.
[[nodiscard]] cv::Mat draw_ground(GroundKind kind, std::uint64_t seed);

/// A smaller seamless tile of fine grain.
[[nodiscard]] cv::Mat draw_ground_grain(std::uint64_t seed);

}  // namespace ellipse
