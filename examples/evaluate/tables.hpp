#pragma once  // SPDX-License-Identifier: MIT

#include <iosfwd>
#include <string>
#include <vector>

#include "examples/evaluate/evaluation.hpp"

namespace evaluate {

/// A table of text for the terminal and the report.
struct Table {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< The first column contains names.
  std::string note;
};

/// [Keipour2021] Table II: the measures of each method on one data set.
[[nodiscard]] Table measures_table(const Evaluation& evaluation, const std::string& dataset);

/// [Keipour2021] Table III: processing times of each method by outcome, and of the reference.
[[nodiscard]] Table times_table(const Evaluation& evaluation, const std::string& dataset);

/// F1 of each method on each sequence; for a sequence without a target, the fraction of frames
/// without an answer.
[[nodiscard]] Table sequences_table(const Evaluation& evaluation, const std::string& dataset);

/// The centre error of each method, by the frame scale of the answer.
[[nodiscard]] Table centre_table(const Evaluation& evaluation, const std::string& dataset);

/// All tables of one data set.
[[nodiscard]] std::vector<Table> all_tables(const Evaluation& evaluation,
                                            const std::string& dataset);

void print(std::ostream& out, const Table& table);

/// The same results as JSON.
void write_json(std::ostream& out, const Evaluation& evaluation);

}  // namespace evaluate
