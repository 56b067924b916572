// SPDX-License-Identifier: MIT
#include "core/scene/wild.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "core/scene/random.hpp"
#include "core/scene/true_ellipses.hpp"
#include "tests/support/photometric_fit.hpp"

namespace ellipse {
namespace {

using support::GrayPicture;

GrayPicture render(const Wild& wild, std::uint64_t frame = 0, double time_s = 0.0) {
  GrayPicture picture(wild.width, wild.height);
  SceneRenderer(wild.scene).render(time_s, frame, picture.writable());
  return picture;
}

// A single shape of a wild scene on a uniform ground, by the same camera with an ideal sensor.
Wild alone(const Wild& wild, const Sheet& sheet, const Shape& shape) {
  Wild one = wild;
  one.scene.ground.kind = GroundKind::kPlain;
  one.scene.ground.level = 200.0;
  one.scene.light = {};
  const Sensor& sensor = wild.scene.sensor;
  one.scene.sensor = {.read_noise = 0.0, .blur_px = std::min(sensor.blur_px, 1.0)};
  one.scene.sensor.readout_s = sensor.readout_s;
  one.scene.sheets = {sheet};
  one.scene.sheets[0].defocus_px = 0.0;
  one.scene.sheets[0].shapes = {shape};
  Shape& only = one.scene.sheets[0].shapes[0];
  only.paint = Paint{one.scene.pad.paint_level};
  only.softness = 0.0;
  // The sky is not uniform ground.
  one.scene.flight.tilt_rad = std::min(wild.scene.flight.tilt_rad, 1.0);
  one.scene.sheets[0].spin_rad_s = 0.0;
  for (Fold& fold : one.scene.sheets[0].folds) fold.shade = 0.0;
  return one;
}

bool is_within(const Ellipse& e, const Wild& wild, double margin_px) {
  const Eigen::Vector2d half = half_extent(e) + Eigen::Vector2d::Constant(margin_px);
  return e.cx > half.x() && e.cy > half.y() && e.cx < wild.width - half.x() &&
         e.cy < wild.height - half.y();
}

// Calls use(lone shape, its ellipses) for listed shapes that are entirely in the picture.
template <class Wanted, class Use>
void for_lone_shapes(int count, const Wanted& is_wanted, const Use& use) {
  int found = 0;
  for (std::uint64_t seed = 1; found < count && seed < 3000; ++seed) {
    const Wild wild = make_wild(seed);
    for (const Sheet& sheet : wild.scene.sheets) {
      const auto shape = std::find_if(
          sheet.shapes.begin(), sheet.shapes.end(), [](const auto& s) { return s.is_listed; });
      if (shape == sheet.shapes.end()) continue;
      const Wild one = alone(wild, sheet, *shape);
      const auto ellipses = true_ellipses(one.scene, 0.0, one.width, one.height);
      if (ellipses.empty() || !is_wanted(one, ellipses)) continue;
      if (!is_within(ellipses[0].ellipse, wild, 8.0)) continue;
      SCOPED_TRACE(seed);
      use(one, ellipses);
      ++found;
      break;
    }
  }
  EXPECT_EQ(found, count);
}

TEST(WildTruth, OfFlatShapesMatchesTheirPixels) {
  const auto is_wanted = [](const Wild& one, const std::vector<TrueEllipse>& ellipses) {
    const double thinnest_px = ellipses.back().ellipse.semi_minor;
    const double ring_px = ellipses.size() > 1 ? ellipses[0].ellipse.semi_minor - thinnest_px : 9.0;
    return ellipses[0].deviation_px == 0.0 && thinnest_px > 10.0 && ring_px > 4.0 &&
           ellipses[0].ellipse.semi_major < 80.0 && one.scene.sensor.readout_s == 0.0;
  };
  for_lone_shapes(16, is_wanted, [](const Wild& one, const std::vector<TrueEllipse>& ellipses) {
    Truth truth;
    truth.outer_edge = ellipses[0].ellipse;
    if (ellipses.size() > 1) truth.inner_edge = ellipses[1].ellipse;
    const GrayPicture picture = render(one);
    const support::Edges edges = support::PhotometricFit(one.scene, picture, truth).run();
    support::expect_same(support::ellipse_of(edges.outer), *truth.outer_edge);
    if (truth.inner_edge) {
      support::expect_same(support::ellipse_of(edges.inner), *truth.inner_edge);
    }
  });
}

double bilinear(const GrayPicture& picture, const Eigen::Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x()));
  const int y = static_cast<int>(std::floor(p.y()));
  const auto* upper = picture.view().row(y) + x;
  const auto* lower = picture.view().row(y + 1) + x;
  return std::lerp(std::lerp<double, double, double>(upper[0], upper[1], p.x() - x),
                   std::lerp<double, double, double>(lower[0], lower[1], p.x() - x),
                   p.y() - y);
}

// Distance of the outline from an ellipse along its normals, outwards, at the mid grey level.
std::vector<double> offsets_from(const Ellipse& e, const GrayPicture& picture, double reach_px) {
  std::vector<double> offsets;
  walk_perimeter(e, [&](const PerimeterStep& step) {
    const double side = step.normal().dot(step.point - e.center()) > 0.0 ? 1.0 : -1.0;
    for (double at = -reach_px; at < reach_px; at += 0.02) {
      if (bilinear(picture, step.point + side * at * step.normal()) > 127.5) {
        offsets.push_back(at);
        return;
      }
    }
  });
  return offsets;
}

TEST(WildTruth, OfDeformedShapesIsTheBestFitAndItsDeviation) {
  const auto is_wanted = [](const Wild&, const std::vector<TrueEllipse>& ellipses) {
    return ellipses.size() == 1 && ellipses[0].deviation_px > 0.15 &&
           ellipses[0].ellipse.semi_minor > 20.0 && ellipses[0].ellipse.aspect_ratio() < 2.5;
  };
  for_lone_shapes(25, is_wanted, [](const Wild& one, const std::vector<TrueEllipse>& ellipses) {
    const TrueEllipse& truth = ellipses[0];
    const std::vector<double> offsets =
        offsets_from(truth.ellipse, render(one), truth.deviation_px + 3.0);
    double largest = 0.0;
    double sum = 0.0;
    for (const double offset : offsets) {
      largest = std::max(largest, std::abs(offset));
      sum += offset;
    }
    EXPECT_NEAR(sum / static_cast<double>(offsets.size()), 0.0, 0.06 + 0.05 * truth.deviation_px);
    EXPECT_NEAR(largest, truth.deviation_px, 0.15 + 0.1 * truth.deviation_px);
  });
}

TEST(Wild, SeedAndFrameDecideThePicture) {
  std::set<std::vector<std::uint8_t>> distinct;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Wild wild = make_wild(seed);
    const GrayPicture picture = render(wild);
    EXPECT_EQ(picture.pixels, render(make_wild(seed)).pixels) << seed;
    EXPECT_TRUE(distinct.insert(picture.pixels).second) << seed;
    EXPECT_EQ(wild.things, make_wild(seed).things);
  }
  const Wild wild = make_wild(3);
  EXPECT_NE(render(wild, 0).pixels, render(wild, 1).pixels);
  EXPECT_NE(render(wild, 0, 0.0).pixels, render(wild, 0, 0.5).pixels);
}

TEST(Wild, AllKindsOfObjectsOccur) {
  std::set<std::string_view> things;
  std::set<WildTheme> themes;
  std::set<double> rates;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const Wild wild = make_wild(seed);
    things.insert(wild.things.begin(), wild.things.end());
    themes.insert(wild.theme);
    rates.insert(wild.frames_per_second);
  }
  for (const char* thing :
       {"ring",        "thin-ring", "disc",        "bullseye",     "x",
        "h",           "number",    "round-plate", "square-plate", "several-pads",
        "folds",       "bend",      "egg",         "superellipse", "defocus",
        "soft-edge",   "glint",     "shadow",      "lid",          "lashes",
        "blink",       "pupil",     "hand",        "person",       "mesh",
        "net",         "fence",     "cable",       "foliage",      "gravel",
        "pavement",    "text",      "field",       "polygon",      "rounded-square",
        "wheel",       "lamp",      "sign",        "ball",         "balloon",
        "board",       "cut",       "room",        "traffic",      "low-contrast",
        "gamma",       "vignette",  "compression", "noise",        "rolling-shutter",
        "motion-blur", "interlaced"}) {
    EXPECT_TRUE(things.contains(thing)) << thing;
  }
  EXPECT_EQ(themes.size(), wild_theme_nicks().size());
  EXPECT_EQ(*rates.begin(), 8.0);
  EXPECT_EQ(*rates.rbegin(), 78.0);
}

TEST(Wild, NegativeScenesListNothing) {
  int negatives = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Wild wild = make_wild(seed);
    const bool is_negative =
        wild.theme == WildTheme::kPolygons || wild.theme == WildTheme::kTextures;
    if (!is_negative) continue;
    ++negatives;
    for (const Sheet& sheet : wild.scene.sheets) {
      EXPECT_EQ(sheet.ball_radius, 0.0) << seed;
      for (const Shape& shape : sheet.shapes) {
        const bool has_corners =
            shape.outline == Outline::kPolygon || shape.outline == Outline::kMesh;
        const bool is_blot = shape.outline == Outline::kWavy && shape.amount >= 0.2;
        EXPECT_TRUE(has_corners || is_blot) << seed;
      }
    }
    for (const double time_s : {0.0, 0.7, 2.0}) {
      EXPECT_TRUE(true_ellipses(wild.scene, time_s, wild.width, wild.height).empty()) << seed;
    }
  }
  EXPECT_GT(negatives, 50);
  EXPECT_LT(negatives, 100);
}

TEST(Wild, AllRoundShapesAreListed) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Wild wild = make_wild(seed);
    EXPECT_NE(wild.scene.ground.kind, GroundKind::kCircles);
    EXPECT_EQ(wild.scene.pad.pattern, Pattern::kNone);
    for (const Sheet& sheet : wild.scene.sheets) {
      for (const Shape& shape : sheet.shapes) {
        if (shape.is_listed) continue;
        const bool is_round = shape.outline == Outline::kEllipse ||
                              shape.outline == Outline::kEgg ||
                              shape.outline == Outline::kSuperellipse ||
                              (shape.outline == Outline::kWavy && shape.amount < 0.2);
        EXPECT_FALSE(is_round) << seed;
      }
    }
  }
}

// Mean change of the grey level across an outline in a picture, outwards.
double contrast_across(const TrueEllipse& truth, const GrayPicture& picture, double reach_px) {
  double sum = 0.0;
  int samples = 0;
  walk_perimeter(truth.ellipse, [&](const PerimeterStep& step) {
    const double side = step.normal().dot(step.point - truth.ellipse.center()) > 0.0 ? 1.0 : -1.0;
    const Eigen::Vector2d reach = side * reach_px * step.normal();
    for (const Eigen::Vector2d& p :
         {Eigen::Vector2d(step.point + reach), Eigen::Vector2d(step.point - reach)}) {
      if (!(p.x() >= 0.0 && p.y() >= 0.0 && p.x() < picture.width - 1 &&
            p.y() < picture.height - 1))
        return;
    }
    sum += bilinear(picture, step.point + reach) - bilinear(picture, step.point - reach);
    ++samples;
  });
  return samples > 0 ? sum / samples : 0.0;
}

TEST(Wild, NearlyAllListedEllipsesAreVisible) {
  int listed = 0;
  int visible = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const Wild wild = make_wild(seed);
    const auto ellipses = true_ellipses(wild.scene, 0.0, wild.width, wild.height);
    if (ellipses.empty()) continue;
    const TrueEllipse& target = ellipses[0];
    const double reach_px = 1.0 + 1.5 * wild.scene.sensor.blur_px + target.deviation_px;
    if (!target.is_target || target.visible_fraction < 0.5) continue;
    if (target.ellipse.semi_minor < 2.0 * reach_px) continue;
    ++listed;
    visible += std::abs(contrast_across(target, render(wild), reach_px)) > 3.0 ? 1 : 0;
  }
  EXPECT_GT(listed, 40);
  EXPECT_GE(visible, 0.93 * listed);
}

}  // namespace
}  // namespace ellipse
