#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>
#include <vector>

#include "core/detection/detector.hpp"
#include "core/edges/edge_refinement.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"

namespace ellipse {

/// Corrects the edges of thin rings among detections.
class RingCorrector {
 public:
  RingCorrector();

  /// Looks for the next edge of each among the others, then on the picture. Where both have the
  /// same contrast, the detection's ellipse becomes the true edge.
  /// @param min_gradient  Of an edge [units of Gradient].
  /// @param polarities      Of the detections.
  /// Allocates only while it has not yet seen as many detections.
  void correct(const ImageView& luma,
               double min_gradient,
               std::span<const Polarity> polarities,
               const LensView& lens,
               std::span<Detection> detections);

 private:
  [[nodiscard]] std::optional<RefinedEllipse> next_edge(const ImageView& luma,
                                                        double min_gradient,
                                                        std::span<const Polarity> polarities,
                                                        const LensView& lens,
                                                        std::size_t i) const;

  std::vector<Ellipse> maxima_;  // the detections, not yet corrected
};

}  // namespace ellipse
