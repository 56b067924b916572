// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {3.00731, -3.82487, 3.93456, 0.946688, -1.04175, -0.172943, -1.15871, -3.40417},
      .means = {0.837113, -2.69304, -0.407595, 4.78069, -4.38609, 2.99389, 3.10268, 0.135366},
      .bias = 0.949358,
  };
  return kTable;
}

}  // namespace ellipse
