// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {1.3981, -3.82057, 4.88269, 0.316536, -1.03638, 0.622857, -0.891476, -2.85621},
      .means = {0.826249, -2.58497, -0.417786, 4.7213, -4.20972, 2.91616, 3.05892, 0.148997},
      .bias = -0.0867952,
  };
  return kTable;
}

}  // namespace ellipse
