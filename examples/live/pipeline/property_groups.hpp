#pragma once  // SPDX-License-Identifier: MIT

#include <string_view>

namespace live {

/// The group of an ellipsetrack property. "detection", "tracking", "scale", "ROI" and "edges"
/// follow the paper; "camera", "output" and "load" are added here. Unknown properties are in
/// "other".
[[nodiscard]] std::string_view group_of(std::string_view property);

/// The unit in square brackets in a property's description: "px", "ns", "grey levels per px"; empty
/// if it has none.
[[nodiscard]] std::string_view unit_in(std::string_view blurb);

}  // namespace live
