// SPDX-License-Identifier: MIT
#include "core/image/image_view.hpp"

#include <algorithm>

namespace ellipse {

Rect intersect(const Rect& a, const Rect& b) {
  const int left = std::max(a.x, b.x);
  const int top = std::max(a.y, b.y);
  const int right = std::min(a.x + a.width, b.x + b.width);
  const int bottom = std::min(a.y + a.height, b.y + b.height);
  if (right <= left || bottom <= top) return {};
  return {left, top, right - left, bottom - top};
}

ImageView ImageView::region(const Rect& rect) const {
  const Rect inside = intersect(rect, bounds());
  if (inside.empty()) return {};
  return {row(inside.y) + inside.x, inside.width, inside.height, stride};
}

}  // namespace ellipse
