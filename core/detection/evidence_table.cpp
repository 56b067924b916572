// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {3.41052, -3.78093, 4.42841, 1.0925, -1.14804, -6.09841, -0.774455, -3.35037},
      .means = {0.831291, -2.55161, -0.393138, 4.63268, -4.13947, 0.00757381, 2.84802, 0.147661},
      .bias = -0.243395,
  };
  return kTable;
}

}  // namespace ellipse
