// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {2.84399, -3.76174, 4.76444, 0.882159, -1.07599, 0.226669, -0.918669, -3.50348},
      .means = {0.831511, -2.5469, -0.389686, 4.62478, -4.1292, 2.81828, 3.3016, 0.146414},
      .bias = -0.134149,
  };
  return kTable;
}

}  // namespace ellipse
