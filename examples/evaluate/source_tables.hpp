#pragma once  // SPDX-License-Identifier: MIT

#include <iosfwd>
#include <span>
#include <vector>

#include "examples/evaluate/source_results.hpp"
#include "examples/evaluate/tables.hpp"

namespace evaluate {

/// F1 of each method on each source, one row per source, with the best peer next to the first
/// method. Marks methods without a significant difference from the first one.
[[nodiscard]] Table source_table(const Evaluation& evaluation,
                                 std::span<const SourceResults> results);

/// The confidence intervals of these values.
[[nodiscard]] Table interval_table(const Evaluation& evaluation,
                                   std::span<const SourceResults> results);

/// Precision, recall and F1 over all ellipses of each source, with centre and axis errors.
[[nodiscard]] Table all_ellipses_table(const Evaluation& evaluation);

/// All tables by source, with that of all ellipses if they were evaluated.
[[nodiscard]] std::vector<Table> source_tables(const Evaluation& evaluation);

/// The same results as JSON: the members "sources" and "all_ellipses".
void write_json_sources(std::ostream& out, const Evaluation& evaluation);

}  // namespace evaluate
