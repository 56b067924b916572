// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {5.40975, -3.67324, 4.72908, 1.56485, -0.659654, -6.57104, -0.563874, -6.66288},
      .means = {0.817495, -2.51474, -0.445769, 4.59163, -4.04975, 0.00717912, 2.84764, 0.177432},
      .bias = -0.760228,
  };
  return kTable;
}

}  // namespace ellipse
