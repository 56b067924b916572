#pragma once  // SPDX-License-Identifier: MIT

#include <algorithm>

#include "core/detection/detector.hpp"
#include "core/geometry/ellipse.hpp"
#include "tests/support/picture.hpp"

namespace support {

/// Thresholds with the overlaps with which a detector searches.
inline ellipse::Thresholds detecting(const ellipse::Detector& detector) {
  ellipse::Thresholds thresholds;
  thresholds.contour_overlap = detector.detecting_overlaps().contour;
  thresholds.ellipse_overlap = detector.detecting_overlaps().ellipse;
  return thresholds;
}

/// The same for a detector of this type.
template <class SomeDetector>
ellipse::Thresholds detecting() {
  return detecting(SomeDetector());
}

/// The intersection over union of the detection closest to the truth; 0 without a detection.
template <class SomeDetector>
double best_iou(const GrayPicture& picture,
                const ellipse::Ellipse& truth,
                const ellipse::Thresholds& thresholds) {
  SomeDetector detector;
  double best = 0.0;
  for (const ellipse::Detection& each : detector.detect(picture.view(), thresholds)) {
    best = std::max(best, iou_inside(each.ellipse, truth, picture.width, picture.height));
  }
  return best;
}

}  // namespace support
