// SPDX-License-Identifier: MIT
#include "core/scene/catalog.hpp"

#include <array>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>

namespace ellipse {
namespace {

Scene seeded(std::uint64_t seed) {
  Scene scene;
  scene.seed = seed;
  return scene;
}

Scene approach(std::uint64_t seed) {
  return seeded(seed);
}

Scene oblique(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.ground.kind = GroundKind::kRoad;
  scene.flight = {Path::kOblique, 16.0, 14.0, 4.0};
  return scene;
}

Scene dusk(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.sensor.gain = 0.14;
  scene.sensor.bias = 2.0;
  scene.sensor.read_noise = 1.5;
  scene.sensor.shot_noise = 0.05;
  return scene;
}

Scene glare(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.ground.kind = GroundKind::kTiles;
  scene.flight = {Path::kApproach, 16.0, 12.0, 3.5};
  scene.light.gradient = {0.5, -0.2};
  scene.light.shadows = {{0.5, 0.4, 0.35, 0.45, 0.02}, {1.9, -1.3, 0.9, 0.5, 0.05}};
  scene.light.glare = {{0.03, -0.02}, 0.06, 260.0};
  return scene;
}

Scene occluded(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.ground.kind = GroundKind::kGrass;
  scene.flight = {Path::kHover, 12.0, 5.0, 5.0};
  scene.bars = {
      {{-0.1, -0.4}, {0.02, 0.4}, 0.012, 40.0, {0.12, 0.0}},
      {{0.5, 0.28}, {0.06, -0.02}, 0.05, 90.0, {0.0, 0.04}},  // a leg
      {{-0.5, 0.1}, {0.5, 0.02}, 0.02, scene.pad.paint_level, {0.0, 0.08}},
  };
  return scene;
}

Scene dash(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.flight = {Path::kDash, 1.0, 8.0, 8.0};
  scene.sensor.exposure_s = 1.0 / 90.0;
  return scene;
}

Scene touchdown(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.flight = {Path::kApproach, 16.0, 8.0, 0.35};
  return scene;
}

Scene reenter(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.ground.kind = GroundKind::kTiles;
  scene.flight = {Path::kReenter, 8.0, 6.0, 6.0};
  return scene;
}

Scene thin(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.pad.ring_width = 0.055;
  scene.pad.mark_width = 0.09;
  scene.flight.highest = 14.0;
  return scene;
}

Scene disc(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.pad.pattern = Pattern::kDisc;
  scene.pad.plate_half_width = 0.0;
  scene.pad.paint_level = 215.0;
  return scene;
}

Scene bullseye(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.pad.pattern = Pattern::kBullseye;
  scene.pad.paint_level = 225.0;
  scene.pad.plate_level = 50.0;
  scene.pad.rim_level = 200.0;
  scene.ground.kind = GroundKind::kGrass;
  return scene;
}

Scene deformed(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.pad.deformation = 0.02;
  return scene;
}

Scene noise(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.flight.highest = 14.0;
  scene.sensor.read_noise = 14.0;
  scene.sensor.jpeg_quality = 45;
  return scene;
}

Scene negative(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.pad.pattern = Pattern::kNone;
  scene.ground.kind = GroundKind::kClutter;
  return scene;
}

Scene orbit(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.pad.pattern = Pattern::kRingH;
  scene.ground.kind = GroundKind::kRoad;
  scene.flight = {Path::kOrbit, 12.0, 8.0, 8.0};
  return scene;
}

Scene shake(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.flight = {Path::kShake, 12.0, 7.0, 7.0};
  scene.sensor.exposure_s = 1.0 / 120.0;
  return scene;
}

Scene hover(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.pad.pattern = Pattern::kRing;
  scene.ground.kind = GroundKind::kClutter;
  scene.flight = {Path::kHover, 12.0, 6.0, 6.0};
  return scene;
}

Scene distractors(std::uint64_t seed) {
  Scene scene = seeded(seed);
  scene.ground.kind = GroundKind::kCircles;
  return scene;
}

constexpr std::array kCatalog = {
    NamedScene{"approach", "Descent from 20 to 2.6 pad radii and climb, 10 s each", approach},
    NamedScene{"oblique", "View at 60 degrees from the vertical, over a road", oblique},
    NamedScene{"dusk", "Approach at one seventh of the light", dusk},
    NamedScene{"glare", "Glare on the pad, shadows and uneven light", glare},
    NamedScene{"occluded", "Swinging bars and a landing leg in front of the pad", occluded},
    NamedScene{"dash", "Lateral motion of 40 px per frame with motion blur", dash},
    NamedScene{"touchdown", "Descent until the pad is larger than the picture", touchdown},
    NamedScene{"reenter", "The pad leaves the picture and returns", reenter},
    NamedScene{"thin", "Thin ring of 0.055 pad radii", thin},
    NamedScene{"disc", "Bright disc without a plate", disc},
    NamedScene{"bullseye", "Concentric bright rings on a dark plate", bullseye},
    NamedScene{"crumpled", "Edge deviates from the ellipse by 2 % of the radius", deformed},
    NamedScene{"noise", "Noise of 14 grey levels and JPEG at quality 45", noise},
    NamedScene{"negative", "No pad; squares, flowers, rounded rectangles and arcs", negative},
    NamedScene{"orbit", "Orbit around a ring with an H, at 45 degrees", orbit},
    NamedScene{"shake", "Hover with vibration at 7 to 11 Hz", shake},
    NamedScene{"hover", "Hover over a ring among clutter", hover},
    NamedScene{"distractors", "Approach over discs and smaller rings", distractors},
};

void barrel(Scene& scene) {
  scene.lens = Distortion{LensModel::kBrownConrady, {-0.22}};
}

// The pad appears half as large as through a lens of 58 degrees. Distances are therefore halved, so
// that it fills the picture at the end of a descent. Lateral motion is doubled to leave the wider
// field of view; kReenter keeps its distance, so that the whole pad stays in front of the camera.
void fisheye(Scene& scene) {
  scene.lens = Distortion{LensModel::kFisheye, {}};
  scene.hfov_rad = 2.0 / 3.0 * std::numbers::pi;
  scene.flight.reach *= 2.0;
  if (scene.flight.path == Path::kReenter) return;
  scene.flight.highest *= 0.5;
  scene.flight.lowest *= 0.5;
}

constexpr std::array kLenses = {
    NamedLens{"barrel", "Brown-Conrady, k1 = -0.22, with the scene's field of view", barrel},
    NamedLens{"fisheye", "Equidistant, 120 degrees, at half the distance", fisheye},
};

constexpr std::array kPatternNicks = {"ring-x", "ring", "disc", "ring-h", "bullseye", "none"};
constexpr std::array kGroundNicks = {"plain",
                                     "asphalt",
                                     "grass",
                                     "road",
                                     "tiles",
                                     "squares",
                                     "flowers",
                                     "rounded",
                                     "clutter",
                                     "circles",
                                     "gravel",
                                     "pavement",
                                     "foliage",
                                     "field",
                                     "page",
                                     "skin",
                                     "polygons",
                                     "blades"};

}  // namespace

std::span<const NamedScene> scene_catalog() {
  return kCatalog;
}

Scene scene_by_name(const char* name, std::uint64_t seed) {
  std::string names;
  for (const NamedScene& entry : kCatalog) {
    if (std::string_view(entry.name) == name) return entry.make(seed);
    names += names.empty() ? entry.name : std::string(", ") + entry.name;
  }
  throw std::invalid_argument("scene \"" + std::string(name) + "\" is none of: " + names);
}

std::span<const NamedLens> lens_catalog() {
  return kLenses;
}

void put_on_lens(Scene& scene, const char* name) {
  std::string names;
  for (const NamedLens& lens : kLenses) {
    if (std::string_view(lens.name) == name) return lens.put_on(scene);
    if (!names.empty()) names += ", ";
    names += lens.name;
  }
  throw std::invalid_argument("lens \"" + std::string(name) + "\" is none of: " + names);
}

std::span<const char* const> pattern_nicks() {
  return kPatternNicks;
}

std::span<const char* const> ground_nicks() {
  return kGroundNicks;
}

}  // namespace ellipse
