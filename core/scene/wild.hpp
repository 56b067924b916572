#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/scene/scene.hpp"

namespace ellipse {

/// Theme of a wild scene.
enum class WildTheme {
  kPad,       ///< Landing pads of all kinds, flat, curved, on cloth, with people around.
  kEye,       ///< A pupil in an iris, lids, lashes, glints, blinks.
  kBoard,     ///< Calibration boards: many discs or rings.
  kTraffic,   ///< A road with vehicles, wheels, lamps and round signs.
  kBalls,     ///< Balls and balloons.
  kCut,       ///< One ellipse that is larger than the picture, or cut by it.
  kPolygons,  ///< No ellipse: pads and plates with corners.
  kTextures,  ///< No ellipse: meshes, fences, foliage, stones, print, roads, rooms, closed eyes.
};

/// A random scene and its camera's format.
struct Wild {
  Scene scene;
  WildTheme theme = WildTheme::kPad;
  int width = 640;
  int height = 360;
  double frames_per_second = 30.0;
  /// Tags of its content: "ring", "hand", "rolling-shutter" and so on, each at most once. The
  /// strings are static.
  std::vector<std::string_view> things;
};

/// A random scene, determined by the seed alone; the first frame, at time 0, is as representative
/// as any other. true_ellipses() lists all its ellipses; no other shape in it is an ellipse. Scenes
/// of the last two themes have no ellipse.
[[nodiscard]] Wild make_wild(std::uint64_t seed);

/// The scene alone, for pictures of any size.
[[nodiscard]] Scene wild_scene(std::uint64_t seed);

/// The names of the themes, in their order.
[[nodiscard]] std::span<const char* const> wild_theme_nicks();

}  // namespace ellipse
