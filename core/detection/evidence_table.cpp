// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {5.42234, -3.69534, 4.73148, 1.56347, -0.646545, -6.51833, -0.558765, -6.71599},
      .means = {0.817544, -2.51388, -0.445339, 4.59282, -4.0476, 0.00734383, 2.84693, 0.177219},
      .bias = -0.759614,
  };
  return kTable;
}

}  // namespace ellipse
