// SPDX-License-Identifier: MIT
//
// Checks the documented effect of each setting against the tracker's behaviour.
#include "core/tracking/setting_effect.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/detection/detectors.hpp"
#include "core/scene/catalog.hpp"
#include "core/tracking/tracker.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;

constexpr DetectorKind kDetectors[] = {DetectorKind::kContours, DetectorKind::kArcs};
constexpr TrackingMode kTrackings[] = {
    TrackingMode::kNone, TrackingMode::kRedetect, TrackingMode::kEdges};
constexpr int kFrames = 6;
constexpr std::int64_t kStepNs = 33'333'333;

using Sequence = std::vector<GrayPicture>;

Sequence sequence_of(const char* name, double start_s) {
  SceneRenderer renderer(scene_by_name(name));
  Sequence frames;
  for (int i = 0; i < kFrames; ++i) {
    GrayPicture picture(640, 360);
    (void)renderer.render(start_s + i / 30.0, static_cast<std::uint64_t>(i), picture.writable());
    frames.push_back(std::move(picture));
  }
  return frames;
}

// A distant target, a near one that changes the scale, a deformed one and an occluded one.
const std::vector<Sequence>& sequences() {
  static const std::vector<Sequence> kSequences = {sequence_of("approach", 1.0),
                                                   sequence_of("approach", 6.5),
                                                   sequence_of("crumpled", 4.0),
                                                   sequence_of("occluded", 0.5)};
  return kSequences;
}

// All numeric outputs of a tracker on a sequence.
using Answers = std::vector<double>;

void add(Answers& answers, const Ellipse& e) {
  answers.insert(answers.end(), {e.cx, e.cy, e.semi_major, e.semi_minor, e.angle_rad});
}

void add(Answers& answers, const Target& target) {
  add(answers, target.ellipse);
  answers.insert(answers.end(),
                 {double(target.id),
                  double(target.state),
                  target.contour_overlap,
                  target.ellipse_overlap,
                  target.visible_fraction,
                  double(target.scale)});
  if (!target.pose) return;
  const TargetPose& pose = *target.pose;
  for (const Eigen::Vector3d& v : {pose.bearing, pose.normal, pose.position_m}) {
    answers.insert(answers.end(), v.begin(), v.end());
  }
}

Answers answers_to(const Sequence& frames, const TrackerSettings& settings, int finest_scale = 1) {
  Tracker tracker(settings);
  Answers answers;
  std::int64_t pts_ns = 0;
  for (const GrayPicture& frame : frames) {
    const PixelView view = frame.view();
    const auto target = tracker.process(view, pts_ns, {view.bounds(), finest_scale});
    const Rect& region = tracker.search_region();
    answers.insert(answers.end(), {double(region.x), double(region.y), double(region.width)});
    if (target) add(answers, *target);
    for (const Detection& candidate : tracker.candidates()) add(answers, candidate.ellipse);
    pts_ns += kStepNs;
  }
  return answers;
}

// Some settings act only with another one, a focal length.
TrackerSettings base_for(const std::string& name, DetectorKind detector, TrackingMode tracking) {
  TrackerSettings settings;
  settings.detector = detector;
  settings.tracking = tracking;
  if (name == "fy" || name == "cx" || name == "cy" || name == "target-diameter") {
    settings.fx_px = 500.0;
  }
  return settings;
}

// The base settings with one setting at several values over its range.
std::vector<TrackerSettings> variants_of(const std::string& name, const TrackerSettings& base) {
  std::vector<TrackerSettings> variants;
  const auto add_if_valid = [&](const std::string& value) {
    TrackerSettings variant = base;
    set_by_name(variant, name, value);
    try {
      variant.validate();
    } catch (const std::invalid_argument&) {
      return;  // conflicts with the other setting of its pair
    }
    if (variant != base) variants.push_back(variant);
  };
  if (name == "refine") {
    for (const char* nick : refinement_nicks()) add_if_valid(nick);
    return variants;
  }
  const auto infos = setting_infos();
  const auto info =
      std::find_if(infos.begin(), infos.end(), [&](const auto& i) { return name == i.name; });
  const Range& range = info->range;
  const double usual = info->get(base);
  const double near = std::max(range.min, 1.0);
  for (const double value :
       {range.min, 0.01, 0.5, 0.6, near, 2.0 * usual, 0.5 * usual, 20.0, 300.0, 0.95, range.max}) {
    if (!range.contains(value) || (info->is_integer && value != std::floor(value))) continue;
    add_if_valid(std::to_string(value));
  }
  return variants;
}

bool changes_anything(const std::vector<TrackerSettings>& variants,
                      const TrackerSettings& base,
                      int finest_scale = 1) {
  for (const Sequence& frames : sequences()) {
    const Answers usual = answers_to(frames, base, finest_scale);
    for (const TrackerSettings& variant : variants) {
      if (answers_to(frames, variant, finest_scale) != usual) return true;
    }
  }
  return false;
}

std::vector<std::string> names() {
  std::vector<std::string> result = {"refine"};
  for (const SettingInfo& info : setting_infos()) result.emplace_back(info.name);
  return result;
}

class SettingEffectOf : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Settings,
                         SettingEffectOf,
                         testing::ValuesIn(names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

double value_of(const std::string& name, const TrackerSettings& settings) {
  const auto infos = setting_infos();
  return std::find_if(infos.begin(), infos.end(), [&](const auto& i) { return name == i.name; })
      ->get(settings);
}

TEST_P(SettingEffectOf, MatchesTheTracker) {
  const std::string& name = GetParam();
  const SettingEffect effect = effect_of(name);
  for (const DetectorKind detector : kDetectors) {
    for (const TrackingMode tracking : kTrackings) {
      SCOPED_TRACE(std::string(detector_nicks()[std::size_t(detector)]) + " " +
                   tracking_nicks()[std::size_t(tracking)]);
      const TrackerSettings base = base_for(name, detector, tracking);
      std::vector<TrackerSettings> variants = variants_of(name, base);
      ASSERT_FALSE(variants.empty());
      const Acts acts = acts_with(effect, detector, tracking);
      EXPECT_EQ(changes_anything(variants, base), acts != Acts::kNever);
      if (acts != Acts::kAbove) continue;
      std::erase_if(variants,
                    [&](const auto& v) { return value_of(name, v) > effect.elsewhere_above; });
      EXPECT_FALSE(changes_anything(variants, base));
    }
  }
}

// Justifies elsewhere_above, once per second of every scene.
TEST(SettingEffect, OfContourOverlapStartsBelowAllValuesOfArcs) {
  const auto arcs = make_detector(DetectorKind::kArcs);
  Thresholds thresholds;
  thresholds.contour_overlap = 0.01;
  thresholds.ellipse_overlap = arcs->detecting_overlaps().ellipse;
  GrayPicture picture(640, 360);
  int count = 0;
  for (const NamedScene& scene : scene_catalog()) {
    SceneRenderer renderer(scene.make(1));
    for (int second = 0; second < 9; ++second) {
      (void)renderer.render(0.5 + second, 0, picture.writable());
      for (const Detection& found : arcs->detect(picture.view(), thresholds)) {
        EXPECT_GT(found.contour_overlap, effect_of("detect-contour-overlap").elsewhere_above);
        ++count;
      }
    }
  }
  EXPECT_GT(count, 200);
}

// The element coarsens the search under load, up to max-scale.
TEST(SettingEffect, OfMaxScaleExistsUnderLoad) {
  EXPECT_STREQ(effect_of("max-scale").otherwise, "max-processing-time");
  for (const DetectorKind detector : kDetectors) {
    for (const TrackingMode tracking : kTrackings) {
      const TrackerSettings base = base_for("max-scale", detector, tracking);
      TrackerSettings finest = base;
      finest.max_scale = 1;
      EXPECT_TRUE(changes_anything({finest}, base, 4));
    }
  }
}

TEST(SettingEffect, IsDescribedInWords) {
  EXPECT_EQ(condition_of(effect_of("max-axis")), "");
  EXPECT_EQ(condition_of(effect_of("refine")), "with tracking=edges only");
  EXPECT_EQ(condition_of(effect_of("track-contour-overlap")),
            "with detector=contours and tracking=redetect; with another detector above 0.65 only");
  EXPECT_EQ(condition_of(effect_of("max-scale")),
            "with tracking=redetect, or together with max-processing-time");
  EXPECT_EQ(blurb_of("Text", effect_of("roi-expansion")), "Text; acts with tracking=redetect only");
  EXPECT_THROW((void)effect_of("no-such"), std::invalid_argument);
}

TEST(SettingsInForce, ReplaceZeroOverlapsByThoseOfTheDetector) {
  TrackerSettings settings;
  settings.detect_overlaps.contour = 0.5;
  settings.detector = DetectorKind::kContours;
  EXPECT_EQ(in_force(settings).detect_overlaps, (Overlaps{0.5, 0.95}));
  EXPECT_EQ(in_force(settings).track_overlaps, (Overlaps{0.7, 0.3}));
  settings.detector = DetectorKind::kArcs;
  EXPECT_EQ(in_force(settings).detect_overlaps, (Overlaps{0.5, 0.0}));
  settings.fx_px = 500.0;
  EXPECT_EQ(in_force(settings).fy_px, 500.0);
}

}  // namespace
}  // namespace ellipse
