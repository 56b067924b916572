#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <span>
#include <vector>

#include "core/detection/detector.hpp"
#include "core/edges/edge_measurement.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

/// Removes the blur bias from detections that are edges of thin rings.
class RingCorrector {
 public:
  RingCorrector();

  /// Finds the ring's other edge for each detection, among the detections or else on the
  /// picture. If both have similar contrast, replaces the detection's ellipse by the unbiased edge.
  /// @param min_gradient  Smallest gradient of an edge [units of Gradient].
  /// @param polarities    Of the detections.
  /// Allocates only when the detections outnumber those of every earlier call.
  void correct(const Picture& picture,
               double min_gradient,
               std::span<const Polarity> polarities,
               std::span<Detection> detections);

 private:
  struct Edge {
    Ellipse ellipse;
    double contrast;
  };

  [[nodiscard]] const Ellipse* closest_partner(std::span<const Polarity> polarities,
                                               std::size_t i) const;
  [[nodiscard]] std::optional<Edge> edge_near(const Picture& picture,
                                              const Ellipse& guess,
                                              Polarity polarity,
                                              double min_gradient);
  [[nodiscard]] std::optional<Edge> edge_beside(const Picture& picture,
                                                const Ellipse& edge,
                                                Polarity polarity,
                                                double min_gradient);

  double min_gap_px_;            // between the gradient maxima of a ring
  std::vector<Ellipse> maxima_;  // the detections before correction
  EdgeMeasurer measurer_;
};

}  // namespace ellipse
