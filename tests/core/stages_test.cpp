// SPDX-License-Identifier: MIT
//
// The small stages around the detector: overlap, thresholds, settings, scale, roi.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "core/detection/contours/overlap.hpp"
#include "core/detection/detectors.hpp"
#include "core/image/roi.hpp"
#include "core/image/scale.hpp"
#include "core/tracking/settings.hpp"
#include "tests/support/picture.hpp"

namespace ellipse {
namespace {

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ImageView, RegionIsClipped) {
  const support::GrayPicture picture(10, 8);
  const ImageView part = picture.view().region({6, -2, 20, 5});
  EXPECT_EQ(part.width, 4);
  EXPECT_EQ(part.height, 3);
  EXPECT_EQ(part.data, picture.pixels.data() + 6);
  EXPECT_TRUE(picture.view().region({10, 0, 5, 5}).empty());
}

TEST(ContourOverlap, IsShareOfPixelsNearTheEllipse) {
  const Ellipse circle{50.0, 50.0, 20.0, 20.0, 0.0};
  const std::array<cv::Point, 4> contour = {
      cv::Point{70, 50}, cv::Point{50, 31}, cv::Point{30, 50}, cv::Point{50, 50}};
  EXPECT_DOUBLE_EQ(contour_overlap(contour, circle), 0.75);
  EXPECT_EQ(contour_overlap({}, circle), 0.0);
}

TEST(EllipseOverlap, CountsThePerimeterInsideThePictureOnly) {
  support::GrayPicture edges(100, 100);
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 50; ++x) edges.at(x, y) = 255;
  }
  const Ellipse whole{49.5, 50.0, 20.0, 20.0, 0.0};
  EXPECT_NEAR(perimeter_support(whole, edges.view()).ellipse_overlap(), 0.5, 0.02);
  const Ellipse cut{-0.5, 50.0, 20.0, 20.0, 0.0};
  const PerimeterSupport support = perimeter_support(cut, edges.view());
  EXPECT_DOUBLE_EQ(support.ellipse_overlap(), 1.0);
  EXPECT_NEAR(support.inside_px, std::acos(-1.0) * 20.0, 1.5);
  const Ellipse outside{-80.0, 50.0, 20.0, 20.0, 0.0};
  EXPECT_EQ(perimeter_support(outside, edges.view()).ellipse_overlap(), 0.0);
}

TEST(Thresholds, DefaultsAreThoseOfThePaper) {
  const Thresholds t;
  EXPECT_EQ(t.contour_overlap, 0.95);
  EXPECT_EQ(t.ellipse_overlap, 0.95);
  EXPECT_EQ(t.min_axis_px, 5);
  EXPECT_EQ(t.max_axis_px, kAxisRangePx.max);  // the paper: 700
  EXPECT_EQ(t.max_axis_ratio, 5);
  EXPECT_EQ(t.min_contour_size, 50);
}

TEST(Settings, ErrorNamesTheInvalidThreshold) {
  TrackerSettings t;
  t.limits.max_axis_px = 3.0;
  EXPECT_NE(message_of([&] { t.validate(); }).find("max-axis"), std::string::npos);
  t = {};
  t.detect_overlaps.contour = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of([&] { t.validate(); }).find("detect-contour-overlap"), std::string::npos);
  t = {};
  t.limits.edge_low = 9.0;
  t.limits.edge_high = 5.0;
  EXPECT_NE(message_of([&] { t.validate(); }).find("edge-low"), std::string::npos);
}

TEST(Thresholds, ScaleWithThePicture) {
  const Thresholds at_four = Thresholds{}.at_scale(4);
  EXPECT_EQ(at_four.max_axis_px, kAxisRangePx.max / 4.0);
  EXPECT_EQ(at_four.min_axis_px, 1.25);
  EXPECT_EQ(at_four.min_contour_size, 14);
  EXPECT_EQ(at_four.contour_overlap, 0.95);
}

TEST(TrackerSettings, NumbersAreSetByName) {
  for (const SettingInfo& info : setting_infos()) {
    TrackerSettings settings;
    const double value = info.is_integer ? 100.0 : 0.5 * info.range.max;
    set_by_name(settings, info.name, std::to_string(value));
    EXPECT_EQ(info.get(settings), value) << info.name;
  }
}

TEST(TrackerSettings, EvidenceIsSetByTheNameOfAFile) {
  const std::string file = testing::TempDir() + "settings_evidence.txt";
  EvidenceTable table = built_in_evidence();
  table.bias += 1.0;
  {
    std::ofstream out(file);
    write_evidence(out, table);
  }
  TrackerSettings settings;
  set_by_name(settings, "evidence-file", file);
  EXPECT_NEAR(settings.evidence.bias, table.bias, 1e-5);
  set_by_name(settings, "evidence-file", "");
  EXPECT_EQ(settings.evidence, built_in_evidence());
  EXPECT_THROW(set_by_name(settings, "evidence-file", file + ".missing"), std::invalid_argument);
  EXPECT_EQ(settings.evidence, built_in_evidence());
}

TEST(TrackerSettings, ChoicesAreSetByNick) {
  TrackerSettings s;
  const auto set_each = [&](const char* name, std::span<const char* const> nicks, auto& field) {
    for (std::size_t i = 0; i < nicks.size(); ++i) {
      set_by_name(s, name, nicks[i]);
      EXPECT_EQ(static_cast<std::size_t>(field), i) << name << ' ' << nicks[i];
    }
  };
  set_each("detector", detector_nicks(), s.detector);
  set_each("tracking", tracking_nicks(), s.tracking);
  set_each("refine", refinement_nicks(), s.refine);
}

TEST(TrackerSettings, IntegerSettingsRejectFractions) {
  TrackerSettings s;
  EXPECT_NE(message_of([&] { set_by_name(s, "min-contour-size", "60.5"); }).find("whole number"),
            std::string::npos);
  EXPECT_EQ(s, TrackerSettings{});
  set_by_name(s, "min-axis", "60.5");
  EXPECT_EQ(s.limits.min_axis_px, 60.5);
}

TEST(Detectors, HaveTheDocumentedOverlaps) {
  const auto contours = make_detector(DetectorKind::kContours);
  EXPECT_EQ(contours->detecting_overlaps(), (Overlaps{0.95, 0.95}));  // [Keipour2021] Table I
  EXPECT_EQ(contours->tracking_overlaps(), (Overlaps{0.7, 0.3}));
  const auto arcs = make_detector(DetectorKind::kArcs);
  EXPECT_EQ(arcs->detecting_overlaps(), Overlaps{});
  EXPECT_EQ(arcs->tracking_overlaps(), Overlaps{});
}

TEST(TrackerSettings, RejectUnknownNamesAndInvalidValues) {
  TrackerSettings s;
  const auto set = [&](const char* name, const char* value) {
    return message_of([&] { set_by_name(s, name, value); });
  };
  EXPECT_NE(set("no-such-thing", "1").find("no-such-thing"), std::string::npos);
  EXPECT_NE(set("min-axis", "many").find("min-axis"), std::string::npos);
  EXPECT_NE(set("min-axis", "nan").find("min-axis"), std::string::npos);
  EXPECT_NE(set("roi-expansion", "99").find("roi-expansion"), std::string::npos);
  EXPECT_NE(set("tracking", "magic").find("redetect"), std::string::npos);
  EXPECT_NE(set("detector", "magic").find("arcs"), std::string::npos);
  EXPECT_NE(set("refine", "magic").find("photometric"), std::string::npos);
  EXPECT_EQ(s, TrackerSettings{});
}

TEST(TrackerSettings, RejectInvertedPairs) {
  TrackerSettings s;
  s.min_target_size_px = 500.0;
  EXPECT_NE(message_of([&] { s.validate(); }).find("max-target-size"), std::string::npos);
}

TEST(Scaler, AveragesBlocksAndDropsTheRemainder) {
  support::GrayPicture picture(5, 4, 10);
  picture.at(0, 0) = 50;
  Scaler scaler;
  const ImageView half = scaler.reduce(picture.view(), 2);
  EXPECT_EQ(half.width, 2);
  EXPECT_EQ(half.height, 2);
  EXPECT_EQ(half.row(0)[0], 20);
  EXPECT_EQ(half.row(1)[1], 10);
  EXPECT_EQ(scaler.reduce(picture.view(), 1).data, picture.pixels.data());
  EXPECT_TRUE(scaler.reduce(picture.view(), 8).empty());
}

TEST(Scale, RegionAndFrameAreInverse) {
  const Ellipse e{100.3, 50.7, 20.0, 10.0, 0.3};
  const Ellipse there = to_region(e, {32, 16, 100, 100}, 4);
  EXPECT_NEAR(there.cx, (100.3 - 32 + 0.5) / 4 - 0.5, 1e-12);
  EXPECT_NEAR(to_frame(there, {32, 16, 100, 100}, 4).cy, e.cy, 1e-12);
}

TEST(Rect, UnitedIgnoresEmptyRectangles) {
  const Rect a{10, 20, 30, 40};
  EXPECT_EQ(united(a, {50, 10, 5, 5}), (Rect{10, 10, 45, 50}));
  EXPECT_EQ(united(a, {}), a);
  EXPECT_EQ(united({500, 500, 0, 10}, a), a);
}

TEST(Roi, SurroundsTheTargetOnTheGridOfTheScale) {
  const Rect roi = calculate_roi({100.0, 80.0, 20.0, 10.0, 0.0}, 2.0, 4, 640, 360);
  EXPECT_EQ(roi.x % 4, 0);
  EXPECT_EQ(roi.y % 4, 0);
  EXPECT_LE(roi.x, 60);
  EXPECT_GE(roi.x + roi.width, 141);
  EXPECT_LE(roi.y, 50);
  EXPECT_GE(roi.y + roi.height, 111);
}

TEST(Roi, IsClippedToTheFrame) {
  const Rect all = calculate_roi({5.0, 5.0, 400.0, 300.0, 0.1}, 2.0, 2, 321, 241);
  EXPECT_EQ(all, (Rect{0, 0, 321, 241}));
  EXPECT_TRUE(calculate_roi({-500.0, 5.0, 20.0, 20.0, 0.0}, 2.0, 1, 320, 240).empty());
}

}  // namespace
}  // namespace ellipse
