#pragma once  // SPDX-License-Identifier: MIT

#include <iosfwd>
#include <span>
#include <vector>

#include "examples/evaluate/source_results.hpp"
#include "examples/evaluate/tables.hpp"

namespace evaluate {

/// The figure of each method on each source, a row each, and the best peer beside the first method.
/// A method whose difference from the first one is none is marked.
[[nodiscard]] Table source_table(const Evaluation& evaluation,
                                 std::span<const SourceResults> results);

/// The intervals of these figures.
[[nodiscard]] Table interval_table(const Evaluation& evaluation,
                                   std::span<const SourceResults> results);

/// Precision, recall and F1 of each method over all ellipses of each source, centres and axes.
[[nodiscard]] Table all_ellipses_table(const Evaluation& evaluation);

/// All tables over sources; that of all ellipses where they were asked for.
[[nodiscard]] std::vector<Table> source_tables(const Evaluation& evaluation);

/// The same figures for programs: values of the members "sources" and "all_ellipses".
void write_json_sources(std::ostream& out, const Evaluation& evaluation);

}  // namespace evaluate
