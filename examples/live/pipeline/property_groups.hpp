#pragma once  // SPDX-License-Identifier: MIT

#include <string_view>

namespace live {

/// The purpose of an ellipsetrack property, as in docs/elements.md; "other" if it is unknown.
[[nodiscard]] std::string_view group_of(std::string_view property);

/// The unit in square brackets in a property's description: "px", "ns", "grey levels per px"; empty
/// if it has none.
[[nodiscard]] std::string_view unit_in(std::string_view blurb);

}  // namespace live
