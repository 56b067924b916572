// SPDX-License-Identifier: MIT
#include "examples/evaluate/twin.hpp"

#include <cstdint>

#include "core/scene/catalog.hpp"
#include "examples/evaluate/rendered.hpp"

namespace evaluate {
namespace {

using ellipse::GroundKind;
using ellipse::Scene;

// The parameter that varies between otherwise identical clips.
enum Family { kNone = 0, kNoise = 1, kCrumple = 2, kBoth = 3 };

// Part of a scene: a start time, a number of frames, and a frame interval in 30ths of a second.
struct Clip {
  const char* dataset;
  const char* name;
  const char* scene;
  std::uint64_t seed;
  double from_s;
  int frames;
  int stride;
  void (*change)(Scene&);
  Family family = kNone;
};

void keep(Scene& /*scene*/) {}

template <GroundKind kKind>
void on(Scene& scene) {
  scene.ground.kind = kKind;
}

template <int kPercent>
void crumpled(Scene& scene) {
  scene.pad.deformation = 0.01 * kPercent;
}

template <int kLevels>
void noisy(Scene& scene) {
  scene.sensor.read_noise = kLevels;
}

void noisy_jpeg(Scene& scene) {
  scene.sensor.read_noise = 14.0;
  scene.sensor.jpeg_quality = 45;
}

void bright(Scene& scene) {
  scene.pad.paint_level = 220.0;
  scene.pad.plate_level = 60.0;
  scene.pad.rim_level = 190.0;
}

void thin_ring(Scene& scene) {
  scene.pad.ring_width = 0.055;
  scene.pad.mark_width = 0.09;
}

void thin_dusk(Scene& scene) {
  thin_ring(scene);
  scene.sensor.gain = 0.25;
}

// The seeds are reserved for this data set.
constexpr Clip kClips[] = {
    {"twin", "approach", "approach", 101, 0.0, 140, 2, keep},
    {"twin", "approach-grass", "approach", 102, 3.0, 80, 2, on<GroundKind::kGrass>},
    {"twin", "approach-bright", "approach", 103, 3.0, 60, 2, bright},
    {"twin", "oblique", "oblique", 104, 0.0, 100, 3, keep},
    {"twin", "orbit", "orbit", 105, 0.0, 77, 3, keep},
    {"twin", "dusk", "dusk", 106, 1.0, 100, 2, keep},
    {"twin", "glare", "glare", 107, 1.0, 110, 2, keep},
    {"twin", "occluded", "occluded", 108, 0.0, 90, 2, keep},
    {"twin", "dash", "dash", 109, 0.0, 60, 1, keep},
    {"twin", "shake", "shake", 110, 0.0, 50, 1, keep},
    {"twin", "touchdown", "touchdown", 111, 2.0, 80, 1, keep},
    {"twin", "reenter", "reenter", 112, 0.0, 120, 2, keep},
    {"twin", "disc", "disc", 113, 2.0, 60, 2, keep},
    {"twin", "bullseye", "bullseye", 114, 2.0, 60, 2, keep},
    {"twin", "hover-clutter", "hover", 115, 0.0, 60, 2, keep},
    // The same frames with one parameter changed, to isolate its effect.
    {"twin", "plain", "approach", 116, 4.0, 30, 2, keep, kBoth},
    {"twin", "crumpled-1", "approach", 116, 4.0, 30, 2, crumpled<1>, kCrumple},
    {"twin", "crumpled-2", "approach", 116, 4.0, 30, 2, crumpled<2>, kCrumple},
    {"twin", "crumpled-3", "approach", 116, 4.0, 30, 2, crumpled<3>, kCrumple},
    {"twin", "noise-7", "approach", 116, 4.0, 30, 2, noisy<7>, kNoise},
    {"twin", "noise-14-jpeg", "approach", 116, 4.0, 30, 2, noisy_jpeg, kNoise},
    {"twin", "none-clutter", "negative", 120, 0.0, 24, 10, keep},
    {"twin", "none-flowers", "negative", 121, 1.0, 20, 10, on<GroundKind::kFlowers>},
    {"twin", "none-rounded", "negative", 122, 2.0, 20, 10, on<GroundKind::kRounded>},
    {"twin", "none-road", "negative", 123, 0.0, 20, 10, on<GroundKind::kRoad>},
    {"thin", "thin-approach", "thin", 131, 0.0, 160, 2, keep},
    {"thin", "thin-oblique", "oblique", 132, 2.0, 100, 3, thin_ring},
    {"thin", "thin-dusk", "thin", 133, 2.0, 96, 2, thin_dusk},
    {"thin", "thin-hover", "hover", 134, 0.0, 100, 2, thin_ring},
};

Sequence make_sequence(const Clip& clip, const cv::Mat& ground) {
  Scene scene = ellipse::scene_by_name(clip.scene, clip.seed);
  clip.change(scene);
  if (!ground.empty()) {
    scene.ground.kind = GroundKind::kPicture;
    scene.ground.picture = ground;
  }
  Conditions conditions;
  if ((clip.family & kNoise) != 0) conditions.noise = scene.sensor.read_noise;
  if ((clip.family & kCrumple) != 0) conditions.crumple = scene.pad.deformation;
  const FrameTimes times{clip.from_s, clip.frames, clip.stride};
  return make_rendered(clip.dataset, clip.name, scene, times, conditions);
}

}  // namespace

std::vector<Sequence> make_twin(const cv::Mat& ground) {
  std::vector<Sequence> sequences;
  for (const Clip& clip : kClips) sequences.push_back(make_sequence(clip, ground));
  return sequences;
}

}  // namespace evaluate
