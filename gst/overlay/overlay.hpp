#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include <vector>

#include "core/image/image_view.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/overlay/canvas.hpp"
#include "gst/overlay/overlay_style.hpp"

/// Draws ellipses over frames. Reuses its memory from frame to frame. Not thread-safe.
class Overlay {
 public:
  /// Starts a frame of this size [px].
  void begin(int width, int height);

  /// Draws one ellipse, anti-aliased, clipped to the frame. Implausible ones (NaN, minor axis above
  /// major axis, beyond 1e5 px) are omitted. The size of a label follows the frame's height. It
  /// lies inside the frame and covers neither the ellipse's centre nor another label; without room
  /// for it no label is drawn.
  void draw(const GstEllipseMeta& meta, const OverlayStyle& style);

  /// The drawing since begin().
  [[nodiscard]] const Canvas& canvas() const { return canvas_; }

 private:
  // Covers all parts except the label, with lines widened by wider_px.
  void cover_parts(const GstEllipseMeta& meta, const OverlayStyle& style, double wider_px);
  void draw_label(const GstEllipseMeta& meta, const OverlayStyle& style);

  Canvas canvas_;
  std::vector<ellipse::Rect> taken_;  // labels must not overlap these
};
