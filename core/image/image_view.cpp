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

Rect united(const Rect& a, const Rect& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int left = std::min(a.x, b.x);
  const int top = std::min(a.y, b.y);
  return {left,
          top,
          std::max(a.x + a.width, b.x + b.width) - left,
          std::max(a.y + a.height, b.y + b.height) - top};
}

ImageView ImageView::region(const Rect& rect) const {
  const Rect inside = intersect(rect, bounds());
  if (inside.empty()) return {};
  return {row(inside.y) + inside.x, inside.width, inside.height, stride};
}

}  // namespace ellipse
