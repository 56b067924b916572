// SPDX-License-Identifier: MIT
#include "examples/evaluate/scenes.hpp"

#include <charconv>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "core/scene/catalog.hpp"
#include "examples/evaluate/rendered.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

constexpr double kMaxFrames = 1e6;

[[noreturn]] void reject_scenes(const std::string& text, const std::string& what) {
  throw std::invalid_argument(text + ": " + what);
}

// Parses a number at the start of the rest and removes it.
std::uint64_t take_seed(std::string_view& rest, const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), seed);
  if (error != std::errc{}) reject_scenes(text, "expected a SEED, FROM-TO, or a list of them");
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  return seed;
}

bool take(std::string_view& rest, char separator) {
  const bool is_there = rest.starts_with(separator);
  if (is_there) rest.remove_prefix(1);
  return is_there;
}

FrameTimes times_of(const ScenePace& pace) {
  const double frames = std::round(pace.seconds * pace.frames_per_second);
  if (!(frames >= 1.0 && frames <= kMaxFrames && pace.frames_per_second > 0.0)) {
    throw std::invalid_argument("scenes: --seconds times --fps is out of range");
  }
  return {0.0, static_cast<int>(frames), 1, pace.frames_per_second};
}

// Shares a DistortedFrame among all scenes with the same camera.
class SharedFrames {
 public:
  std::shared_ptr<const DistortedFrame> of(const ellipse::Scene& scene) {
    const ellipse::Camera camera = camera_of(scene, kRenderedWidth, kRenderedHeight);
    for (const auto& known : frames_) {
      if (known->lens().camera() == camera) return known;
    }
    return frames_.emplace_back(std::make_shared<const DistortedFrame>(camera));
  }

 private:
  std::vector<std::shared_ptr<const DistortedFrame>> frames_;
};

void add_scene(const std::string& dataset,
               const ellipse::NamedScene& scene,
               const std::vector<std::uint64_t>& seeds,
               const FrameTimes& times,
               std::vector<Sequence>& sequences) {
  for (const std::uint64_t seed : seeds) {
    const std::string name = format("%s-%llu", scene.name, static_cast<unsigned long long>(seed));
    sequences.push_back(make_rendered(dataset, name, scene.make(seed), times));
  }
}

}  // namespace

std::optional<std::vector<std::uint64_t>> scene_seeds(const std::string& text,
                                                      const std::string& kind,
                                                      std::size_t limit) {
  if (!text.starts_with(kind + ":")) return std::nullopt;
  std::string_view rest = std::string_view(text).substr(kind.size() + 1);
  std::vector<std::uint64_t> seeds;
  do {
    const std::uint64_t from = take_seed(rest, text);
    const std::uint64_t to = take(rest, '-') ? take_seed(rest, text) : from;
    if (to < from) reject_scenes(text, "expected FROM <= TO");
    if (to - from >= limit - seeds.size())
      reject_scenes(text, format("more than %zu seeds", limit));
    for (std::uint64_t i = 0; i <= to - from; ++i) seeds.push_back(from + i);
  } while (take(rest, ','));
  if (!rest.empty()) reject_scenes(text, format("\"%s\" is not a seed", std::string(rest).c_str()));
  return seeds;
}

std::vector<Sequence> make_scenes(const std::vector<std::uint64_t>& seeds, const ScenePace& pace) {
  std::vector<Sequence> sequences;
  for (const ellipse::NamedScene& scene : ellipse::scene_catalog()) {
    add_scene("scenes", scene, seeds, times_of(pace), sequences);
  }
  return sequences;
}

std::optional<std::vector<Sequence>> one_scene_by_name(const std::string& text,
                                                       const ScenePace& pace) {
  for (const ellipse::NamedScene& scene : ellipse::scene_catalog()) {
    const std::string dataset = format("scenes-%s", scene.name);
    const auto seeds = scene_seeds(text, dataset);
    if (!seeds) continue;
    std::vector<Sequence> sequences;
    add_scene(dataset, scene, *seeds, times_of(pace), sequences);
    return sequences;
  }
  constexpr std::string_view kPrefix = "scenes-";
  const auto colon = text.find(':');
  if (!text.starts_with(kPrefix) || colon == std::string::npos) return std::nullopt;
  const std::string name = text.substr(kPrefix.size(), colon - kPrefix.size());
  (void)ellipse::scene_by_name(name.c_str(), 0);  // throws, with the list of names
  return std::nullopt;
}

std::vector<Sequence> make_clutter(const std::vector<std::uint64_t>& seeds, const ScenePace& pace) {
  const FrameTimes times = times_of(pace);
  std::vector<Sequence> sequences;
  for (const ellipse::GroundKind kind : {ellipse::GroundKind::kClutter,
                                         ellipse::GroundKind::kFlowers,
                                         ellipse::GroundKind::kRounded,
                                         ellipse::GroundKind::kSquares,
                                         ellipse::GroundKind::kPolygons,
                                         ellipse::GroundKind::kRoad}) {
    for (const std::uint64_t seed : seeds) {
      ellipse::Scene scene = ellipse::scene_by_name("negative", seed);
      scene.ground.kind = kind;
      const char* ground = ellipse::ground_nicks()[static_cast<std::size_t>(kind)];
      const std::string name = format("%s-%llu", ground, static_cast<unsigned long long>(seed));
      sequences.push_back(make_rendered("clutter", name, scene, times));
    }
  }
  return sequences;
}

std::vector<Sequence> make_distorted(const std::vector<std::uint64_t>& seeds,
                                     const ScenePace& pace) {
  const FrameTimes times = times_of(pace);
  std::vector<Sequence> sequences;
  SharedFrames frames;
  for (const ellipse::NamedScene& named : ellipse::scene_catalog()) {
    for (const ellipse::NamedLens& lens : ellipse::lens_catalog()) {
      for (const std::uint64_t seed : seeds) {
        ellipse::Scene scene = named.make(seed);
        lens.put_on(scene);
        const std::string name =
            format("%s-%s-%llu", named.name, lens.name, static_cast<unsigned long long>(seed));
        sequences.push_back(make_rendered("distorted", name, scene, times, {}, frames.of(scene)));
      }
    }
  }
  return sequences;
}

}  // namespace evaluate
