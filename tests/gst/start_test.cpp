// SPDX-License-Identifier: MIT
//
// ellipsetrack with a setting that is rejected before the pipeline starts.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/detection/evidence.hpp"
#include "tests/gst/tracker_harness.hpp"

namespace {

using support::BusTap;
using support::Owned;
using support::run_pipeline;
using support::TemporaryFolder;

std::string run_tracker(const std::string& settings) {
  return run_pipeline("ellipsetestsrc num-buffers=2 ! ellipsetrack " + settings + " ! fakesink");
}

double number(const Owned<GstElement>& element, const char* name) {
  double value = 0.0;
  g_object_get(element.get(), name, &value, nullptr);
  return value;
}

GstStateChangeReturn start(const Owned<GstElement>& element) {
  return gst_element_set_state(element.get(), GST_STATE_READY);
}

void stop(const Owned<GstElement>& element) {
  gst_element_set_state(element.get(), GST_STATE_NULL);
}

Owned<GstElement> tracker_in_null() {
  return Owned<GstElement>(
      GST_ELEMENT(gst_object_ref_sink(gst_element_factory_make("ellipsetrack", nullptr))));
}

TEST(EllipseTrackStart, FailsForInvertedPairs) {
  const std::string error = run_tracker("min-axis=800 max-axis=700");
  EXPECT_NE(error.find("min-axis = 800 is above max-axis = 700"), std::string::npos) << error;
  EXPECT_EQ(run_tracker("min-axis=20 max-axis=30"), "");
}

TEST(EllipseTrackStart, AcceptsTheValuesOfAPairInAnyOrder) {
  using Settings = std::vector<std::pair<const char*, const char*>>;
  for (const Settings& settings :
       {Settings{{"min-axis", "800"}, {"max-axis", "900"}},
        Settings{{"max-axis", "900"}, {"min-axis", "800"}},
        Settings{{"max-axis", "30"}, {"min-axis", "800"}, {"max-axis", "900"}}}) {
    const Owned<GstElement> element = tracker_in_null();
    BusTap bus(element.get());
    for (const auto& [name, value] : settings) {
      gst_util_set_object_arg(G_OBJECT(element.get()), name, value);
    }
    EXPECT_FALSE(bus.pop(GST_MESSAGE_WARNING));
    EXPECT_EQ(number(element, "min-axis"), 800.0);
    EXPECT_EQ(number(element, "max-axis"), 900.0);
    EXPECT_EQ(start(element), GST_STATE_CHANGE_SUCCESS);
    stop(element);
  }
}

TEST(EllipseTrackStart, FailsForUnreadableCameraFiles) {
  const TemporaryFolder folder;
  const std::string missing = run_tracker("camera-file=" + folder.file("no-such.yaml"));
  EXPECT_NE(missing.find(folder.file("no-such.yaml")), std::string::npos) << missing;
  std::ofstream(folder.file("bad.yaml")) << "image_width: twelve\n";
  const std::string bad = run_tracker("camera-file=" + folder.file("bad.yaml"));
  EXPECT_NE(bad.find(folder.file("bad.yaml")), std::string::npos) << bad;
}

TEST(EllipseTrackStart, FailsForUnreadableEvidenceFiles) {
  const TemporaryFolder folder;
  const std::string missing = run_tracker("evidence-file=" + folder.file("no-such.txt"));
  EXPECT_NE(missing.find(folder.file("no-such.txt")), std::string::npos) << missing;
  std::ofstream(folder.file("bad.txt")) << "radius much\n";
  const std::string bad = run_tracker("evidence-file=" + folder.file("bad.txt"));
  EXPECT_NE(bad.find(folder.file("bad.txt") + ":1"), std::string::npos) << bad;
}

TEST(EllipseTrackStart, UsesTheGivenEvidenceFile) {
  const TemporaryFolder folder;
  ellipse::EvidenceTable sceptical = ellipse::built_in_evidence();
  sceptical.bias = -30.0;
  std::ofstream file(folder.file("sceptical.txt"));
  ellipse::write_evidence(file, sceptical);
  file.close();
  const auto harness = support::harness_of("ellipsetrack name=t tracking=none",
                                           support::caps_of("GRAY8", 320, 240),
                                           support::caps_of("GRAY8", 320, 240));
  const auto target_in = [&](std::uint64_t frame) {
    const ellipse::Ellipse pad{160.0, 120.0, 40.0, 32.0, 0.4};
    const auto picture = support::rendered(ellipse::Scene{}, pad, 320, 240, frame);
    const auto buffer = support::push(harness, support::gray_buffer_of(picture));
    return gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET) != nullptr;
  };
  GstElement* element = support::element_of(harness);
  EXPECT_TRUE(target_in(0));
  g_object_set(element, "evidence-file", folder.file("sceptical.txt").c_str(), nullptr);
  EXPECT_FALSE(target_in(1));
  g_object_set(element, "evidence-file", "/no/such/table.txt", nullptr);
  EXPECT_FALSE(target_in(2));
  g_object_set(element, "evidence-file", "", nullptr);
  EXPECT_TRUE(target_in(3));
}

TEST(EllipseTrackStart, FailsForMalformedVectors) {
  const std::string error = run_tracker("roi=\"<1,2,3>\"");
  EXPECT_NE(error.find("roi"), std::string::npos) << error;
}

TEST(EllipseTrackStart, SucceedsAfterTheValuesAreCorrected) {
  const Owned<GstElement> element = tracker_in_null();
  g_object_set(element.get(), "camera-file", "/no/such/file.yaml", "max-axis", 700.0, nullptr);
  g_object_set(element.get(), "min-axis", 800.0, nullptr);
  EXPECT_EQ(number(element, "min-axis"), 5.0);
  EXPECT_EQ(start(element), GST_STATE_CHANGE_FAILURE);
  g_object_set(element.get(), "camera-file", "", nullptr);
  EXPECT_EQ(start(element), GST_STATE_CHANGE_FAILURE);
  g_object_set(element.get(), "interval", 3U, "min-axis", 10.0, nullptr);
  EXPECT_EQ(start(element), GST_STATE_CHANGE_SUCCESS);
  EXPECT_EQ(number(element, "min-axis"), 10.0);
  EXPECT_EQ(number(element, "max-axis"), 700.0);
  stop(element);
}

// A value rejected while running is discarded; a warning reported it.
TEST(EllipseTrackStart, IgnoresValuesRejectedWhileRunning) {
  const Owned<GstElement> element = tracker_in_null();
  g_object_set(element.get(), "max-axis", 700.0, nullptr);
  ASSERT_EQ(start(element), GST_STATE_CHANGE_SUCCESS);
  g_object_set(element.get(), "camera-file", "/no/such/file.yaml", "min-axis", 800.0, nullptr);
  stop(element);
  EXPECT_EQ(start(element), GST_STATE_CHANGE_SUCCESS);
  EXPECT_EQ(number(element, "min-axis"), 5.0);
  stop(element);
}

}  // namespace
