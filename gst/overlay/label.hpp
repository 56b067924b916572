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
  double scale = 0.0;   ///< Of the font: its capitals are 21 px high at 1.
  ellipse::Rect box{};  ///< With its margins [px].
};

/// Black, 0x000000, for bright colours and white, 0xffffff, for dark ones.
[[nodiscard]] std::uint32_t contrast_to(std::uint32_t argb);

/// Measures a text for a frame of this size: capitals of 5 px and a sixtieth of its height, and
/// less where the text would be too wide. nullopt where it could not be read.
[[nodiscard]] std::optional<Label> make_label(std::string text, int frame_width, int frame_height);

/// Where the label's box goes in a frame: below the ellipse, else above it, else at the frame's
/// bottom or top. It leaves this gap to the ellipse where it can, and meets no rectangle that is
/// taken. nullopt where there is no room.
[[nodiscard]] std::optional<ellipse::Rect> place_label(const Label& label,
                                                       const ellipse::Ellipse& e,
                                                       double gap_px,
                                                       const ellipse::Rect& frame,
                                                       std::span<const ellipse::Rect> taken);

/// Draws it in this colour, 0xAARRGGBB, on a box that is dark behind bright text and bright behind
/// dark text.
void draw_label(Canvas& canvas, const Label& label, std::uint32_t argb);
