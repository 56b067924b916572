#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <bit>
#include <cstddef>

#include "core/camera/picture.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/image/scale.hpp"

namespace ellipse {

/// A picture at full size, half and a quarter, and a gradient map for each. A scale is 1, 2 or 4.
///
/// Borrows the picture until the next reduce(). One object serves one thread. Allocates nothing in
/// the steady state.
class Pyramid {
 public:
  explicit Pyramid(Simd simd) : maps_{GradientMap(simd), GradientMap(simd), GradientMap(simd)} {}

  /// Reduces a picture down to coarsest_scale().
  void reduce(const Picture& picture);

  /// Coarsest scale of this picture: kCoarsestScale over the picture's own scale, at least 1.
  [[nodiscard]] int coarsest_scale() const;
  [[nodiscard]] const Picture& picture_at(int scale) const { return pictures_[level_of(scale)]; }
  /// Of any part of the picture at this scale: reduce() does not compute it.
  [[nodiscard]] GradientMap& map_at(int scale) { return maps_[level_of(scale)]; }

 private:
  [[nodiscard]] static std::size_t level_of(int scale) {
    return static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(scale)));
  }

  std::array<Picture, 3> pictures_;
  std::array<GradientMap, 3> maps_;
  std::array<Scaler, 2> scalers_;  // each to the next smaller picture
};

}  // namespace ellipse
