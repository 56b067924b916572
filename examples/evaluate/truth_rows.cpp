// SPDX-License-Identifier: MIT
#include "examples/evaluate/truth_rows.hpp"

#include <cmath>
#include <numbers>

namespace evaluate {
namespace {

void check_axes(const Row& row, const ellipse::Ellipse& e) {
  if (!(e.semi_major >= e.semi_minor && e.semi_minor > 0.0)) {
    row.fail("the axes must be major >= minor > 0");
  }
}

// The inner edge of a ring is concentric and of the same shape.
ellipse::Ellipse inner_edge(const Row& row, ellipse::Ellipse outer, double semi_major) {
  if (!(semi_major > 0.0 && semi_major < outer.semi_major)) {
    row.fail("inner_semi_major must be above 0 and below semi_major");
  }
  outer.semi_minor *= semi_major / outer.semi_major;
  outer.semi_major = semi_major;
  return outer;
}

}  // namespace

Truth truth_of_csv(const Row& row) {
  Truth truth;
  int empty = 0;
  for (const char* column : {"cx", "cy", "semi_major", "semi_minor", "angle_rad"}) {
    empty += row.text(column).empty() ? 1 : 0;
  }
  if (empty == 5) return truth;
  if (empty > 0) row.fail("some fields of the ellipse are empty");
  truth.target = ellipse::Ellipse{row.number("cx"),
                                  row.number("cy"),
                                  row.number("semi_major"),
                                  row.number("semi_minor"),
                                  row.number("angle_rad")};
  check_axes(row, *truth.target);
  truth.visible_fraction = row.optional_number("visible_fraction");
  if (!truth.visible_fraction) truth.visible_fraction = row.optional_number("visible");
  const double visible = truth.visible_fraction.value_or(1.0);
  if (visible < 0.0 || visible > 1.0) row.fail("visible_fraction must be from 0 to 1");
  if (const auto inner = row.optional_number("inner_semi_major")) {
    truth.others.push_back({inner_edge(row, *truth.target, *inner), truth.visible_fraction});
  }
  return truth;
}

Truth truth_of_published(const Row& row) {
  Truth truth;
  if (row.number("HasTarget") == 0.0) return truth;
  truth.is_labelled = row.number("TargetWidth") >= 0.0;
  if (!truth.is_labelled) return truth;
  const double major_rad = (row.number("TargetAngle") + 90.0) * std::numbers::pi / 180.0;
  truth.target = ellipse::Ellipse{row.number("TargetCenterX"),
                                  row.number("TargetCenterY"),
                                  row.number("TargetHeight") / 2.0,
                                  row.number("TargetWidth") / 2.0,
                                  std::remainder(major_rad, std::numbers::pi)};
  check_axes(row, *truth.target);
  return truth;
}

}  // namespace evaluate
