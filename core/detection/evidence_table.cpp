// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {6.31058, -3.45963, 4.58759, 1.6271, -0.788299, -6.29504, -0.64558, -6.74407},
      .means = {0.830643, -2.46723, -0.397699, 4.56273, -3.99978, 0.00785781, 2.77868, 0.179143},
      .bias = -0.657091,
  };
  return kTable;
}

}  // namespace ellipse
