#pragma once  // SPDX-License-Identifier: MIT

#include <iosfwd>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// Text in rows and columns, for the terminal and for the report.
struct Table {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< The first column holds names.
  std::string note;
};

/// [Keipour2021] Table II: the measures of each method on one data set.
[[nodiscard]] Table measures_table(const Evaluation& evaluation, const std::string& dataset);

/// [Keipour2021] Table III: the times of each method by outcome, beside the reference's.
[[nodiscard]] Table times_table(const Evaluation& evaluation, const std::string& dataset);

/// F1 of each method on each sequence; where a sequence has no target, the share of its frames
/// in which rightly none was found.
[[nodiscard]] Table sequences_table(const Evaluation& evaluation, const std::string& dataset);

/// The error of the centre of each method, by the frame scale at which the target was found.
[[nodiscard]] Table centre_table(const Evaluation& evaluation, const std::string& dataset);

/// All of them, of one data set.
[[nodiscard]] std::vector<Table> all_tables(const Evaluation& evaluation,
                                            const std::string& dataset);

void print(std::ostream& out, const Table& table);

/// The same figures for programs.
void write_json(std::ostream& out, const Evaluation& evaluation);

}  // namespace evaluate
