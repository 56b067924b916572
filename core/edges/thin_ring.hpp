#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>

#include "core/geometry/ellipse.hpp"
#include "core/geometry/robust.hpp"

namespace ellipse {

/// The two edges of a painted ring.
struct RingEdges {
  Ellipse outer;
  Ellipse inner;
};

/// A ring without blur bias.
struct UnblurredRing {
  RingEdges edges;
  double sigma_px = 0.0;  ///< Of the correction of an edge.
  Estimate width;         ///< Over the radius of the middle line.
};

/// Removes the blur bias that separates a thin ring's two gradient maxima.
///
/// Blur separates the gradient maxima of a bar, more so for thinner bars: at zero width they are
/// two standard deviations of the blur apart. Their middle line stays in place, and the width of
/// the ring is a constant share of its radius, so that one parameter determines both edges. The
/// blur is at least that of a lens in focus, see kSharpVariance. Distance and sharpness determine
/// the blur and the width within limits, which are far apart for thin rings: the largest width
/// counts, and its standard deviation contains the others. The lower limit is 0 if the ring is out
/// of focus and too thin to show its width. If the ratio of the radii is known, the width closest
/// to it counts instead. Edges that are far apart stay in place. Assumes equal contrast on both
/// sides of the ring.
///
/// Own derivation, see docs/provenance.md. Allocates nothing.
/// @param sharpness    Of the edges.
/// @param known_ratio  Of inner to outer radius, if known.
[[nodiscard]] UnblurredRing without_blur_bias(const RingEdges& maxima,
                                              const Estimate& sharpness,
                                              std::optional<double> known_ratio = {});

/// The same for motion blur, which separates the edges across the motion if the ring is thinner
/// than the blur: the width is that along the motion.
/// @param blur_px  As of motion_blur().
[[nodiscard]] RingEdges without_motion_blur(const RingEdges& maxima,
                                            const Eigen::Vector2d& blur_px);

/// Whether gradient maxima with this sharpness are so close that blur displaces them.
[[nodiscard]] bool is_thin(const RingEdges& maxima, double sharpness);

/// Distance of the two gradient maxima of a very thin bar along an axis [px]. The first call of
/// this or of the functions above computes a table in about 20 ms, see BlurredBars.
[[nodiscard]] double min_maxima_distance();

/// Largest ratio of inner to outer radius at which a ring is distinguished from a line.
inline constexpr double kMaxRingRatio = 0.97;

/// Whether two ellipses may be the edges of one ring: concentric, with a ratio of semi-major axes
/// from 1/4 to kMaxRingRatio.
[[nodiscard]] bool are_partners(const Ellipse& a, const Ellipse& b);

}  // namespace ellipse
