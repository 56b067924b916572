// SPDX-License-Identifier: MIT
#include "core/scene/wild.hpp"

#include <array>

#include "core/scene/wild_draft.hpp"

namespace ellipse {
namespace {

constexpr std::array kNicks = {
    "pad", "eye", "board", "traffic", "balls", "cut", "polygons", "textures"};

// Shares of the themes, in their order; 100 in all. The last two have no ellipse.
constexpr std::array kShares = {38, 12, 6, 7, 7, 6, 10, 14};

WildTheme theme_of(std::uint64_t seed) {
  Random random(hash(seed ^ 0x7468656d65U));
  int draw = random.below(100);
  std::size_t theme = 0;
  while (draw >= kShares[theme]) draw -= kShares[theme++];
  return static_cast<WildTheme>(theme);
}

}  // namespace

Wild make_wild(std::uint64_t seed) {
  wild::Draft draft(seed, theme_of(seed));
  switch (draft.wild.theme) {
    case WildTheme::kPad:
      wild::make_pads(draft);
      break;
    case WildTheme::kEye:
      wild::make_eye(draft, false);
      break;
    case WildTheme::kBoard:
      wild::make_board(draft);
      break;
    case WildTheme::kTraffic:
      wild::make_traffic(draft, true);
      break;
    case WildTheme::kBalls:
      wild::make_balls(draft);
      break;
    case WildTheme::kCut:
      wild::make_cut(draft);
      break;
    case WildTheme::kPolygons:
      wild::make_polygons(draft);
      break;
    case WildTheme::kTextures:
      wild::make_textures(draft);
      break;
  }
  return draft.wild;
}

Scene wild_scene(std::uint64_t seed) {
  return make_wild(seed).scene;
}

std::span<const char* const> wild_theme_nicks() {
  return kNicks;
}

}  // namespace ellipse
