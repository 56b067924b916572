#pragma once  // SPDX-License-Identifier: MIT

#include <string_view>

namespace live {

/// The group of a property of ellipsetrack, as the paper groups its parameters: "detection",
/// "tracking", "scale", "ROI", "edges"; and "camera", "output" and "load", which it does not have.
/// "other" for one that is not known here.
[[nodiscard]] std::string_view group_of(std::string_view property);

/// The unit in brackets in a property's description: "px", "ns", "grey levels per px", or nothing.
[[nodiscard]] std::string_view unit_in(std::string_view blurb);

}  // namespace live
