#pragma once  // SPDX-License-Identifier: MIT

#include <iosfwd>
#include <string>
#include <vector>

#include "examples/evaluate/measures.hpp"

namespace evaluate {

struct NamedMeasures {
  std::string name;
  Measures measures;
};

/// All sequences taken together, named "total".
[[nodiscard]] NamedMeasures total(const std::vector<NamedMeasures>& sequences);

/// The measures of [Keipour2021] Table II, a row a sequence.
void print_measures(std::ostream& out, const std::vector<NamedMeasures>& rows);

/// The times of [Keipour2021] Table III by outcome, beside those of edges and contours alone.
void print_times(std::ostream& out, const Measures& measures);

/// The error of the centre by the frame scale that the target was found at.
void print_centre_errors(std::ostream& out, const Measures& measures);

/// The same figures for programs.
void write_json(std::ostream& out, const std::vector<NamedMeasures>& rows);

}  // namespace evaluate
