// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {3.30278, -3.79802, 3.79881, 1.10822, -1.05835, -0.311098, -1.17232, -3.36461},
      .means = {0.810858, -2.60344, -0.46197, 4.75008, -4.2645, 2.95825, 3.04924, 0.155611},
      .bias = -0.186215,
  };
  return kTable;
}

}  // namespace ellipse
