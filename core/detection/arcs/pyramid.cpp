// SPDX-License-Identifier: MIT
#include "core/detection/arcs/pyramid.hpp"

#include <algorithm>

#include "core/detection/detector.hpp"

namespace ellipse {

void Pyramid::reduce(const Picture& picture) {
  pictures_[0] = picture;
  for (std::size_t level = 1; level <= level_of(coarsest_scale()); ++level) {
    const Picture& finer = pictures_[level - 1];
    pictures_[level] = {scalers_[level - 1].reduce(finer.luma, 2),
                        picture.lens.reduced(1 << level),
                        picture.scale << level};
  }
}

int Pyramid::coarsest_scale() const {
  return std::max(1, kCoarsestScale / pictures_[0].scale);
}

}  // namespace ellipse
