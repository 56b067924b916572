// SPDX-License-Identifier: MIT
#include "examples/evaluate/rendered.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "core/scene/renderer.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

constexpr FrameSize kSize{kRenderedWidth, kRenderedHeight};

Truth truth_at(const ellipse::Scene& scene, const ellipse::Camera& camera, double time_s) {
  const Eigen::Matrix3d view = image_from_pad(pose_at(scene.flight, time_s), camera);
  const ellipse::Truth shown = ellipse::truth_of(scene.pad, view, camera);
  Truth truth{shown.outer_edge, shown.visible_fraction};
  if (!is_in_view(truth, kSize)) truth = {};
  truth.is_complete = scene.ground.kind != ellipse::GroundKind::kCircles;
  return truth;
}

class RenderedPictures : public PictureSource {
 public:
  RenderedPictures(const ellipse::Scene& scene, const FrameTimes& times)
      : scene_(scene), times_(times) {}

  cv::Mat picture(const Frame& frame) override {
    if (!renderer_) renderer_.emplace(scene_);
    cv::Mat picture(kSize.height, kSize.width, CV_8UC1);
    renderer_->render(
        times_.at_s(frame.number),
        frame.number,
        {picture.data, kSize.width, kSize.height, static_cast<std::ptrdiff_t>(picture.step)});
    const bool is_last = frame.number + 1 == static_cast<std::size_t>(times_.frames);
    if (is_last) renderer_.reset();
    return picture;
  }

 private:
  ellipse::Scene scene_;
  FrameTimes times_;
  // Created for the first frame and released after the last: its ground takes much time and memory.
  std::optional<ellipse::SceneRenderer> renderer_;
};

}  // namespace

Sequence make_rendered(const std::string& dataset,
                       const std::string& name,
                       const ellipse::Scene& scene,
                       const FrameTimes& times,
                       const Conditions& conditions,
                       std::shared_ptr<const DistortedFrame> distortion) {
  Sequence sequence{
      dataset, name, {}, std::make_shared<RenderedPictures>(scene, times), std::move(distortion)};
  const ellipse::Camera camera = camera_of(scene, kSize.width, kSize.height);
  for (int i = 0; i < times.frames; ++i) {
    const auto number = static_cast<std::size_t>(i);
    const double time_s = times.at_s(number);
    sequence.frames.push_back({format("%s/frame%04d.png", name.c_str(), i),
                               {},
                               number,
                               std::llround(1e9 * time_s),
                               truth_at(scene, camera, time_s),
                               conditions});
  }
  return sequence;
}

}  // namespace evaluate
