// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

namespace ellipse {

const EvidenceTable& built_in_evidence() {
  static const EvidenceTable kTable{
      .weights = {4.22478, -3.47533, 3.54906, 1.81168, -1.16573, -0.713373, -1.0221, -3.81924},
      .means = {0.834847, -2.55751, -0.395758, 4.64277, -4.17586, 2.83666, 3.02665, 0.16392},
      .bias = -0.206187,
  };
  return kTable;
}

}  // namespace ellipse
