// SPDX-License-Identifier: MIT
//
// Heap allocations per frame in the steady state: none, outside OpenCV.
#include "tests/bench/allocations.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/detection/arcs/arc_detector.hpp"
#include "core/detection/contours/contour_detector.hpp"
#include "core/detection/contours/overlap.hpp"
#include "core/detection/target_selection.hpp"
#include "core/geometry/ellipse_fit.hpp"
#include "core/image/luma.hpp"
#include "core/image/scale.hpp"
#include "core/scene/catalog.hpp"
#include "core/scene/renderer.hpp"
#include "core/tracking/pad/pad_tracker.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;

const Ellipse kRing{150.0, 110.0, 50.0, 35.0, 0.4};

template <class Call>
std::int64_t allocations_of(const Call& call) {
  const bench::HeapMeter meter;
  call();
  return meter.allocations();
}

// Allocations in the last of four calls; the buffers grow in the first three.
template <class Call>
std::int64_t steady_allocations_of(const Call& call) {
  for (int i = 0; i < 3; ++i) call();
  return allocations_of(call);
}

GrayPicture ring_picture() {
  return support::rendered(support::plain_ring(), kRing);
}

GrayPicture noisy_picture() {
  GrayPicture picture(320, 240);
  SceneRenderer(scene_by_name("noise")).render(5.0, 0, picture.writable());
  return picture;
}

PixelView bgr_view(const std::vector<std::uint8_t>& bytes, int width, int height) {
  return {bytes.data(), width, height, 3L * width, {PixelLayout::Kind::kRgb, 3, 0, 2, 1, 0}};
}

class Allocations : public testing::Test {
 protected:
  Allocations() { cv::setNumThreads(1); }  // Thread jobs allocate.
};

TEST_F(Allocations, AreCounted) {
  EXPECT_TRUE(bench::counts_allocations());
}

TEST_F(Allocations, PeakIsTheMaximumAtOneTime) {
  const bench::HeapMeter meter;
  for (int i = 0; i < 3; ++i) {
    void* volatile block = std::malloc(100'000);  // volatile: keeps the call
    std::free(block);
  }
  const std::int64_t peak_bytes = meter.peak_bytes();
  EXPECT_GE(peak_bytes, 100'000);
  EXPECT_LT(peak_bytes, 200'000);
}

TEST_F(Allocations, NoneInFits) {
  std::vector<Eigen::Vector2d> points;
  walk_perimeter(kRing, [&](const PerimeterStep& step) { points.push_back(step.point); });
  const auto fit = [&] {
    const std::optional<Ellipse> direct = fit_ellipse(points);
    GeometricFit geometric(*direct);
    for (const Eigen::Vector2d& point : points) geometric.add(point);
    return geometric.solve();
  };
  EXPECT_TRUE(fit().has_value());
  EXPECT_EQ(allocations_of(fit), 0);
}

TEST_F(Allocations, NoneInOverlaps) {
  std::vector<cv::Point> contour;
  walk_perimeter(kRing, [&](const PerimeterStep& step) {
    contour.emplace_back(cvRound(step.point.x()), cvRound(step.point.y()));
  });
  const GrayPicture edges(320, 240, 255);
  double overlaps = 0.0;
  const auto overlap = [&] {
    overlaps =
        contour_overlap(contour, kRing) + perimeter_support(kRing, edges.view()).ellipse_overlap();
  };
  EXPECT_EQ(allocations_of(overlap), 0);
  EXPECT_GT(overlaps, 1.9);
}

TEST_F(Allocations, NoneInSelection) {
  const std::vector<Detection> detections(256, {kRing, 1.0, 1.0, 100.0});
  std::optional<Detection> selected;
  EXPECT_EQ(allocations_of([&] { selected = select_target(detections, kRing); }), 0);
  EXPECT_TRUE(selected.has_value());
}

TEST_F(Allocations, NoneInLumaOfARegionThatMoves) {
  const std::vector<std::uint8_t> bytes(3UL * 320 * 240, 90);
  LumaReader reader;
  int x = 0;
  const auto read = [&] {
    reader.begin(bgr_view(bytes, 320, 240));
    return reader.read({x += 10, 20, 100 - x, 80}).width;
  };
  EXPECT_EQ(steady_allocations_of(read), 0);
}

TEST_F(Allocations, NoneInScaler) {
  Scaler scaler;
  for (int scale = 1; scale <= 128; scale *= 2) {
    const GrayPicture picture(3840, 2 * scale);
    EXPECT_EQ(steady_allocations_of([&] { return scaler.reduce(picture.view(), scale).width; }), 0);
  }
}

TEST_F(Allocations, NoneInArcDetector) {
  for (const GrayPicture& picture : {ring_picture(), noisy_picture(), GrayPicture(320, 240, 90)}) {
    ArcDetector detector;
    for (const int min_contour : {50, 20}) {  // the default, and shorter
      Thresholds thresholds;
      thresholds.min_contour_size = min_contour;
      const auto detect = [&] { return detector.detect(picture.view(), thresholds).size(); };
      EXPECT_EQ(steady_allocations_of(detect), 0) << min_contour;
    }
  }
}

TEST_F(Allocations, NoneInRendererOfAnyScene) {
  GrayPicture picture(160, 120);
  for (const NamedScene& named : scene_catalog()) {
    SceneRenderer renderer(named.make(1));
    double time_s = 2.0;
    const auto render = [&] { return renderer.render(time_s += 0.1, 0, picture.writable()); };
    EXPECT_EQ(steady_allocations_of(render), 0) << named.name;
  }
}

// The OpenCV calls of [Keipour2021] Algorithm 1 as the detector makes them, without the rest.
class OpenCvCalls {
 public:
  void run(const GrayPicture& picture, const EdgeThresholds& edges) {
    const cv::Mat mat(
        picture.height, picture.width, CV_8UC1, const_cast<std::uint8_t*>(picture.pixels.data()));
    cv::GaussianBlur(mat, smooth_, {5, 5}, 1.0, 1.0, cv::BORDER_REPLICATE);
    cv::spatialGradient(smooth_, gx_, gy_, 3, cv::BORDER_REPLICATE);
    cv::Canny(gx_, gy_, edges_, 8.0 * edges.low, 8.0 * edges.high, true);
    cv::dilate(edges_, thick_, cv::Mat());
    cv::findContours(edges_, contours_, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
    std::erase_if(contours_, [](const auto& contour) { return contour.size() < 50; });
  }

 private:
  cv::Mat smooth_;
  cv::Mat gx_;
  cv::Mat gy_;
  cv::Mat edges_;
  cv::Mat thick_;
  std::vector<std::vector<cv::Point>> contours_;
};

TEST_F(Allocations, OfContourDetectorEqualThoseOfOpenCv) {
  for (const GrayPicture& picture : {ring_picture(), noisy_picture(), GrayPicture(320, 240, 90)}) {
    ContourDetector detector;
    const auto of_detector =
        steady_allocations_of([&] { return detector.detect(picture.view(), {}).size(); });
    OpenCvCalls calls;
    const auto of_opencv =
        steady_allocations_of([&] { calls.run(picture, detector.edge_thresholds()); });
    EXPECT_GT(of_opencv, 0);
    EXPECT_EQ(of_detector, of_opencv);
  }
}

// A detector without allocations, so that the tracker's remain.
class OneEllipse final : public Detector {
 public:
  std::span<const Detection> detect(const ellipse::Picture&, const Thresholds&) override {
    return {&detection_, 1};
  }
  [[nodiscard]] Overlaps detecting_overlaps() const override { return {0.9, 0.9}; }
  [[nodiscard]] Overlaps tracking_overlaps() const override { return {0.9, 0.9}; }

 private:
  Detection detection_{{60.0, 60.0, 30.0, 25.0}, 1.0, 1.0, 100.0};
};

TEST_F(Allocations, NoneInTrackerAroundItsDetector) {
  const std::vector<std::uint8_t> bytes(3UL * 320 * 240, 90);
  for (const char* tracking : tracking_nicks()) {
    TrackerSettings settings;
    set_by_name(settings, "tracking", tracking);
    Tracker tracker(settings, std::make_unique<OneEllipse>());
    const auto process = [&] { return tracker.process(bgr_view(bytes, 320, 240), 0).has_value(); };
    EXPECT_TRUE(process());
    EXPECT_EQ(steady_allocations_of(process), 0) << tracking;
  }
}

// Scenes with pads that have lines or none, that grow, and that leave the picture.
struct Film {
  const char* scene;
  double from_s;
};

constexpr Film kFilms[] = {{"approach", 4.5}, {"hover", 2.0}, {"touchdown", 2.5}};
constexpr int kFilmFrames = 50;

template <class Use>
void show(const Film& film, const Use& use) {
  SceneRenderer renderer(scene_by_name(film.scene, 201));
  GrayPicture picture(320, 180);
  for (int i = 0; i < kFilmFrames; ++i) {
    const Truth truth =
        renderer.render(film.from_s + i / 30.0, static_cast<std::uint64_t>(i), picture.writable());
    use(i, picture.view(), truth);
  }
}

TEST_F(Allocations, NoneInPadTrackerOnceItIsLocked) {
  for (const Film& film : kFilms) {
    PadTracker tracker;
    show(film, [&](int i, const ImageView& luma, const Truth& truth) {
      const PadFrame frame{luma, {320.0, 180.0}};
      if (i == 0) {
        EXPECT_TRUE(tracker.lock(frame, *truth.outer_edge)) << film.scene;
        return;
      }
      std::optional<PadTrack> track;
      EXPECT_EQ(allocations_of([&] { track = tracker.track(frame, ellipse::kFrame_s); }), 0)
          << film.scene << ' ' << i;
      EXPECT_TRUE(track && track->is_visible) << film.scene << ' ' << i;
    });
  }
}

TEST_F(Allocations, NoneWhereEdgesAreNotMatched) {
  const GrayPicture ring = ring_picture();
  const GrayPicture ground(320, 240, 90);
  PadTracker tracker;
  ASSERT_TRUE(tracker.lock({ring.view(), {320.0, 240.0}}, kRing));
  for (int i = 0; i < 20; ++i) {
    std::optional<PadTrack> track;
    const PadFrame frame{ground.view(), {320.0, 240.0}};
    EXPECT_EQ(allocations_of([&] { track = tracker.track(frame, ellipse::kFrame_s); }), 0) << i;
    EXPECT_FALSE(track && track->is_visible) << i;
  }
}

// Counts in the second run over the same frames, after the detector's buffers have grown.
TEST_F(Allocations, NoneInTrackerThatFollowsEdges) {
  constexpr int kFirstFrames = 10;  // in which it locks
  TrackerSettings settings;
  set_by_name(settings, "tracking", "edges");
  for (const Film& film : kFilms) {
    Tracker tracker(settings);
    for (const bool is_second : {false, true}) {
      tracker.reset();
      int followed = 0;
      show(film, [&](int i, const ImageView& luma, const Truth&) {
        std::optional<Target> target;
        const auto process = [&] { target = tracker.process(luma, i * 33'333'333LL); };
        const std::int64_t allocations = allocations_of(process);
        if (i < kFirstFrames) return;
        followed += target && target->state == TargetState::kTracked ? 1 : 0;
        if (!is_second) return;
        EXPECT_EQ(allocations, 0) << film.scene << ' ' << i;
      });
      EXPECT_EQ(followed, kFilmFrames - kFirstFrames) << film.scene;
    }
  }
}

// A lens weak enough that the films need no distortion.
TEST_F(Allocations, NoneThroughALens) {
  TrackerSettings settings;
  settings.camera = Camera::with_hfov(1.012, 640, 360);
  settings.camera->distortion = {-1e-4};
  settings.target_diameter_m = 1.5;
  Tracker tracker(settings);
  for (const bool is_second : {false, true}) {
    tracker.reset();
    show(kFilms[0], [&](int i, const ImageView& luma, const Truth&) {
      std::optional<Target> target;
      const auto process = [&] { target = tracker.process(luma, i * 33'333'333LL); };
      const std::int64_t allocations = allocations_of(process);
      if (!is_second || i < 10) return;
      EXPECT_EQ(allocations, 0) << i;
      EXPECT_TRUE(target && target->pose) << i;
    });
  }
}

TEST_F(Allocations, OfTrackerDoNotAccumulate) {
  const GrayPicture picture = ring_picture();
  Tracker tracker;
  const bench::HeapMeter meter;
  std::int64_t pts_ns = 0;
  const auto peak_after = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      static_cast<void>(tracker.process(picture.view(), pts_ns += 33'333'333));
    }
    return meter.peak_bytes();
  };
  const std::int64_t at_first = peak_after(10);  // includes the first periodic detection
  EXPECT_EQ(peak_after(100), at_first);
}

}  // namespace
}  // namespace ellipse
