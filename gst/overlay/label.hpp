#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"
#include "gst/overlay/canvas.hpp"

/// A line of text on a rounded box.
struct Label {
  std::string text;
  double scale = 0.0;   ///< Font scale; at 1 capitals are 21 px high.
  ellipse::Rect box{};  ///< Including its margins [px].
};

/// Black, 0x000000, for bright colours and white, 0xffffff, for dark ones.
[[nodiscard]] std::uint32_t contrast_to(std::uint32_t argb);

/// Lays out a text for a frame of this size. Capitals are 5 px plus a sixtieth of the frame's
/// height high, less if the text would be too wide. nullopt if it would not be readable.
[[nodiscard]] std::optional<Label> make_label(std::string text, int frame_width, int frame_height);

/// The position of a label's box in a frame: below the ellipse, else above it, else at the frame's
/// bottom or top. It keeps this gap to the ellipse if possible, and overlaps no rectangle in
/// `taken`. nullopt if there is no room.
[[nodiscard]] std::optional<ellipse::Rect> place_label(const Label& label,
                                                       const ellipse::Ellipse& e,
                                                       double gap_px,
                                                       const ellipse::Rect& frame,
                                                       std::span<const ellipse::Rect> taken);

/// Draws it in this colour, 0xAARRGGBB, on a dark box for bright text and a bright box for dark
/// text.
void draw_label(Canvas& canvas, const Label& label, std::uint32_t argb);
