// SPDX-License-Identifier: MIT
#include "core/detection/detectors.hpp"

#include "core/detection/arcs/arc_detector.hpp"
#include "core/detection/contours/contour_detector.hpp"

namespace ellipse {

std::span<const char* const> detector_nicks() {
  static constexpr const char* kNicks[] = {"contours", "arcs"};
  return kNicks;
}

std::unique_ptr<Detector> make_detector(DetectorKind kind) {
  if (kind == DetectorKind::kArcs) return std::make_unique<ArcDetector>();
  return std::make_unique<ContourDetector>();
}

}  // namespace ellipse
