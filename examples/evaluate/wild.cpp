// SPDX-License-Identifier: MIT
#include "examples/evaluate/wild.hpp"

#include <cmath>
#include <memory>

#include "core/scene/renderer.hpp"
#include "core/scene/true_ellipses.hpp"
#include "core/scene/wild.hpp"
#include "examples/evaluate/scenes.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

constexpr std::size_t kMaxWildSeeds = 100000;

Truth truth_of(const std::vector<ellipse::TrueEllipse>& shown) {
  Truth truth;
  for (const ellipse::TrueEllipse& one : shown) {
    if (!truth.target) {
      truth.target = one.ellipse;
      truth.visible_fraction = one.visible_fraction;
    } else {
      truth.others.push_back({one.ellipse, one.visible_fraction});
    }
  }
  return truth;
}

class WildPictures : public PictureSource {
 public:
  WildPictures(std::uint64_t seed, std::size_t frames) : seed_(seed), frames_(frames) {}

  cv::Mat picture(const Frame& frame) override {
    if (!made_) made_ = std::make_unique<Made>(seed_);
    const ellipse::Wild& wild = made_->wild;
    cv::Mat picture(wild.height, wild.width, CV_8UC1);
    made_->renderer.render(
        static_cast<double>(frame.number) / wild.frames_per_second,
        frame.number,
        {picture.data, wild.width, wild.height, static_cast<std::ptrdiff_t>(picture.step)});
    if (frame.number + 1 == frames_) made_.reset();
    return picture;
  }

 private:
  struct Made {
    explicit Made(std::uint64_t seed) : wild(ellipse::make_wild(seed)), renderer(wild.scene) {}
    ellipse::Wild wild;
    ellipse::SceneRenderer renderer;
  };

  std::uint64_t seed_;
  std::size_t frames_;
  std::unique_ptr<Made> made_;  // expensive; released after the last frame
};

Sequence make_sequence(std::uint64_t seed, double seconds) {
  const ellipse::Wild wild = ellipse::make_wild(seed);
  const double rate = wild.frames_per_second;
  const auto frames = static_cast<std::size_t>(std::max(1.0, std::round(seconds * rate)));
  const char* theme = ellipse::wild_theme_nicks()[static_cast<std::size_t>(wild.theme)];
  Sequence sequence{"wild",
                    format("%s-%llu", theme, static_cast<unsigned long long>(seed)),
                    {},
                    std::make_shared<WildPictures>(seed, frames)};
  for (std::size_t i = 0; i < frames; ++i) {
    const double time_s = static_cast<double>(i) / rate;
    sequence.frames.push_back({format("%s/frame%04zu.png", sequence.name.c_str(), i),
                               {},
                               i,
                               std::llround(1e9 * time_s),
                               truth_of(true_ellipses(wild.scene, time_s, wild.width, wild.height)),
                               {}});
  }
  return sequence;
}

}  // namespace

std::vector<Sequence> make_wild(const std::vector<std::uint64_t>& seeds, double seconds) {
  std::vector<Sequence> sequences;
  for (const std::uint64_t seed : seeds) sequences.push_back(make_sequence(seed, seconds));
  return sequences;
}

std::optional<std::vector<Sequence>> wild_by_name(const std::string& text, double seconds) {
  if (const auto seeds = scene_seeds(text, "wild", kMaxWildSeeds)) {
    return make_wild(*seeds, seconds);
  }
  if (const auto seeds = scene_seeds(text, "wild-frames", kMaxWildSeeds)) {
    return make_wild(*seeds, 0.0);
  }
  return std::nullopt;
}

}  // namespace evaluate
