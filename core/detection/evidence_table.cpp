// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {4.76368, -3.5266, 3.27416, 1.83663, -1.15502, -0.816102, -1.01935, -3.62468},
      .means = {0.838431, -2.56196, -0.400884, 4.6442, -4.19043, 2.85253, 3.02639, 0.162469},
      .bias = -0.213731,
  };
  return kTable;
}

}  // namespace ellipse
