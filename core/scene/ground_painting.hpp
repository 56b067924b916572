#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace ellipse {

/// What lies around the pad. Most hold what resembles an ellipse, none but the circles hold one.
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
  kPicture,   ///< A picture of one's own.
};

/// Width and height of what draw_ground() gives [texels].
inline constexpr int kGroundTileSize = 1024;

/// A tile of a ground whose borders meet: grey levels relative to the ground's mean, as floats.
[[nodiscard]] cv::Mat draw_ground(GroundKind kind, std::uint64_t seed);

/// A smaller one of fine grain.
[[nodiscard]] cv::Mat draw_ground_grain(std::uint64_t seed);

}  // namespace ellipse
