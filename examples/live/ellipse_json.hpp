#pragma once  // SPDX-License-Identifier: MIT

#include "core/geometry/ellipse.hpp"
#include "examples/live/json_writer.hpp"

namespace live {

/// Begins an object with the parameters of an ellipse [px, rad] as its first members; the caller
/// ends it.
inline JsonWriter& begin_ellipse(JsonWriter& json, const ellipse::Ellipse& e) {
  return json.begin_object()
      .member("cx", e.cx)
      .member("cy", e.cy)
      .member("semi_major", e.semi_major)
      .member("semi_minor", e.semi_minor)
      .member("angle_rad", e.angle_rad);
}

}  // namespace live
