#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include <vector>

#include "core/image/image_view.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "gst/overlay/canvas.hpp"
#include "gst/overlay/overlay_style.hpp"

/// What is drawn over one frame after another. Keeps its memory from frame to frame. Not
/// thread-safe.
class Overlay {
 public:
  /// Starts a frame of this size [px].
  void begin(int width, int height);

  /// Draws one ellipse, anti-aliased, clipped to the frame. One that is no picture's (NaN, axes the
  /// wrong way round, beyond 1e5 px) is left out. A label is as large as the frame's height has it,
  /// lies inside the frame, and covers neither the ellipse's centre nor another label; where there
  /// is no room for one there is none.
  void draw(const GstEllipseMeta& meta, const OverlayStyle& style);

  /// What was drawn since begin().
  [[nodiscard]] const Canvas& canvas() const { return canvas_; }

 private:
  // Covers all parts but the label, each line wider by this.
  void cover_parts(const GstEllipseMeta& meta, const OverlayStyle& style, double wider_px);
  void draw_label(const GstEllipseMeta& meta, const OverlayStyle& style);

  Canvas canvas_;
  std::vector<ellipse::Rect> taken_;  // where no label may come
};
