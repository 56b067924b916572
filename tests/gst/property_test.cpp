// SPDX-License-Identifier: MIT
#include <gst/controller/controller.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "tests/gst/any_property.hpp"
#include "tests/gst/support.hpp"
#include "tests/gst/tracker_harness.hpp"

namespace {

using support::BusTap;
using support::element_of;
using support::gray_buffer_of;
using support::Owned;
using support::push;
using support::ring_picture;
using support::target_on;
using support::tracker;

// GStreamer reads presets once, at the first request.
class TestPresets : public testing::Environment {
 public:
  void SetUp() override { gst_preset_set_app_dir(ELLIPSE_TEST_PRESETS); }
};
[[maybe_unused]] const testing::Environment* const kPresets =
    testing::AddGlobalTestEnvironment(new TestPresets);

template <class Number>
Number value_of(GstElement* element, const char* name) {
  Number value{};
  g_object_get(element, name, &value, nullptr);
  return value;
}

TEST(EllipseTrackProperties, HaveTheDocumentedFlags) {
  const auto harness = tracker();
  const std::set<std::string> controllable{"detect-contour-overlap",
                                           "detect-ellipse-overlap",
                                           "track-contour-overlap",
                                           "track-ellipse-overlap",
                                           "min-axis",
                                           "max-axis",
                                           "max-axis-ratio",
                                           "min-contour-size",
                                           "min-target-size",
                                           "max-target-size",
                                           "roi-expansion",
                                           "edge-low",
                                           "edge-high",
                                           "min-probability"};
  guint count = 0;
  GParamSpec** specs =
      g_object_class_list_properties(G_OBJECT_GET_CLASS(element_of(harness)), &count);
  for (guint i = 0; i < count; ++i) {
    if (specs[i]->owner_type != G_OBJECT_TYPE(element_of(harness))) continue;
    const std::string name = specs[i]->name;
    const bool is_writable = (specs[i]->flags & G_PARAM_WRITABLE) != 0;
    EXPECT_EQ((specs[i]->flags & GST_PARAM_CONTROLLABLE) != 0, controllable.contains(name)) << name;
    EXPECT_EQ((specs[i]->flags & GST_PARAM_MUTABLE_PLAYING) != 0, is_writable) << name;
    EXPECT_FALSE(std::string(g_param_spec_get_blurb(specs[i])).empty()) << name;
  }
  g_free(specs);
  EXPECT_GT(count, controllable.size());
}

// The value of an element's property.
class Read {
 public:
  Read(GstElement* element, GParamSpec* spec) : spec_(spec) {
    g_value_init(&value_, spec->value_type);
    g_object_get_property(G_OBJECT(element), spec->name, &value_);
  }
  ~Read() { g_value_unset(&value_); }
  Read(const Read&) = delete;
  Read& operator=(const Read&) = delete;

  bool operator==(const GValue& other) const {
    return g_param_values_cmp(spec_, &value_, &other) == 0;
  }

 private:
  GParamSpec* spec_;
  GValue value_ = G_VALUE_INIT;
};

class EachElement : public testing::TestWithParam<const char*> {
 protected:
  const Owned<GstElement> element_{gst_element_factory_make(GetParam(), nullptr)};
};

TEST_P(EachElement, StartsWithItsDeclaredDefaults) {
  for (GParamSpec* spec : support::settings_of(element_.get())) {
    const bool is_own = spec->owner_type == G_OBJECT_TYPE(element_.get());
    if (!is_own || GST_IS_PARAM_SPEC_ARRAY_LIST(spec)) continue;  // arrays have no default
    EXPECT_TRUE(Read(element_.get(), spec) == *g_param_spec_get_default_value(spec)) << spec->name;
  }
}

INSTANTIATE_TEST_SUITE_P(Elements,
                         EachElement,
                         testing::Values("ellipsetrack", "ellipseoverlay", "ellipsetestsrc"));

// Elements whose settings do not constrain each other.
class FreeElement : public EachElement {};

TEST_P(FreeElement, KeepsEachGivenNumber) {
  for (GParamSpec* spec : support::settings_of(element_.get())) {
    if (spec->owner_type != G_OBJECT_TYPE(element_.get())) continue;
    for (const double number : {1.0, 0.0, 2.0}) {
      support::PropertyValue wanted(spec);
      wanted.be(number);
      if (!wanted.is_valid()) continue;  // GLib would change it
      wanted.give_to(element_.get());
      EXPECT_TRUE(Read(element_.get(), spec) == wanted.value()) << spec->name << ' ' << number;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Elements,
                         FreeElement,
                         testing::Values("ellipseoverlay", "ellipsetestsrc"));

TEST(EllipseTrackProperties, EnumTypesArePartOfThePluginApi) {
  const auto harness = tracker();
  auto* klass = G_OBJECT_GET_CLASS(element_of(harness));
  for (const char* name : {"detector", "tracking", "refine", "messages", "roi-source", "overlay"}) {
    const GParamSpec* spec = g_object_class_find_property(klass, name);
    ASSERT_NE(spec, nullptr) << name;
    EXPECT_TRUE(gst_type_is_plugin_api(spec->value_type, nullptr)) << name;
  }
}

// A property interpolates linearly between values at whole seconds of stream time.
void control(GstElement* element, const char* name, const std::map<int, double>& values) {
  GstControlSource* source = gst_interpolation_control_source_new();
  g_object_set(source, "mode", GST_INTERPOLATION_MODE_LINEAR, nullptr);
  gst_object_add_control_binding(
      GST_OBJECT(element),
      gst_direct_control_binding_new_absolute(GST_OBJECT(element), name, source));
  for (const auto& [at_s, value] : values) {
    gst_timed_value_control_source_set(GST_TIMED_VALUE_CONTROL_SOURCE(source),
                                       static_cast<GstClockTime>(at_s) * GST_SECOND,
                                       value);
  }
  gst_object_unref(source);
}

TEST(EllipseTrackProperties, FollowACurveOverStreamTime) {
  const auto harness = tracker("tracking=none");
  GstElement* element = element_of(harness);
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  segment.time = 10 * GST_SECOND;
  gst_harness_push_event(harness.get(), gst_event_new_segment(&segment));
  control(element, "max-axis", {{10, 150.0}, {11, 50.0}});
  std::string pattern;  // the ring is 100 px across, its inner edge 79.5
  for (guint64 i = 0; i < 8; ++i) {
    auto buffer = gray_buffer_of(ring_picture());
    GST_BUFFER_PTS(buffer.get()) = (50 + 100 * i) * GST_MSECOND;
    const auto out = push(harness, std::move(buffer));
    const GstEllipseMeta* meta = target_on(out);
    pattern += meta == nullptr ? '.' : meta->semi_major > 45.0 ? 'O' : 'o';
    EXPECT_NEAR(value_of<double>(element, "max-axis"), 145.0 - 10.0 * static_cast<double>(i), 1e-6);
  }
  EXPECT_EQ(pattern, "OOOOOoo.");
}

// Each rejected value posts a warning; a control curve posts one per excursion out of range.
TEST(EllipseTrackProperties, RejectedValuesOfACurveCauseOneWarning) {
  const auto harness = tracker("tracking=none max-axis=700");
  GstElement* element = element_of(harness);
  BusTap bus(element);
  for (const double value : {800.0, 900.0}) g_object_set(element, "min-axis", value, nullptr);
  EXPECT_TRUE(bus.pop(GST_MESSAGE_WARNING));
  EXPECT_TRUE(bus.pop(GST_MESSAGE_WARNING));
  g_object_set(element, "min-axis", 5.0, nullptr);
  control(element, "min-axis", {{0, 600.0}, {1, 800.0}, {2, 600.0}, {3, 800.0}});
  int warnings = 0;
  for (guint64 i = 0; i <= 30; ++i) {
    auto buffer = gray_buffer_of(ring_picture());
    GST_BUFFER_PTS(buffer.get()) = 100 * i * GST_MSECOND;
    push(harness, std::move(buffer));
    while (bus.pop(GST_MESSAGE_WARNING)) ++warnings;
  }
  EXPECT_EQ(warnings, 2);
}

TEST(EllipseTrackPreset, AppliesCompletelyOverAnyValues) {
  for (const char* before : {"min-axis=2 max-axis=3",
                             "max-axis=900 min-axis=800",
                             "detect-contour-overlap=0.5 min-axis=9 max-scale=3"}) {
    const auto harness = tracker(before);
    GstElement* element = element_of(harness);
    BusTap bus(element);
    ASSERT_TRUE(gst_preset_load_preset(GST_PRESET(element), "Keipour 2021"));
    EXPECT_EQ(value_of<double>(element, "min-axis"), 5.0) << before;
    EXPECT_EQ(value_of<double>(element, "max-axis"), 700.0) << before;
    EXPECT_EQ(value_of<double>(element, "detect-contour-overlap"), 0.95) << before;
    EXPECT_EQ(value_of<guint>(element, "max-scale"), 100U) << before;
    EXPECT_EQ(value_of<int>(element, "tracking"), 1) << before;
    EXPECT_FALSE(bus.pop(GST_MESSAGE_WARNING)) << before;
  }
}

// Every setting that affects detection changes.
TEST(EllipseTrackPreset, KeipourPresetSetsAllDetectionSettings) {
  const auto harness = tracker(
      "max-target-size=300 min-target-size=200 roi-expansion=5 refine=photometric ring-ratio=0.5 "
      "edge-high=40 edge-low=30 interval=3 max-axis-ratio=2 min-contour-size=9 "
      "track-contour-overlap=0.1 track-ellipse-overlap=0.1 detect-ellipse-overlap=0.1");
  GstElement* element = element_of(harness);
  ASSERT_TRUE(gst_preset_load_preset(GST_PRESET(element), "Keipour 2021"));
  const std::map<const char*, double> expected = {{"min-target-size", 40.0},
                                                  {"max-target-size", 120.0},
                                                  {"roi-expansion", 2.0},
                                                  {"ring-ratio", 0.0},
                                                  {"edge-low", 0.0},
                                                  {"edge-high", 0.0},
                                                  {"max-axis-ratio", 5.0},
                                                  {"track-contour-overlap", 0.7},
                                                  {"track-ellipse-overlap", 0.3},
                                                  {"detect-ellipse-overlap", 0.95}};
  for (const auto& [name, value] : expected)
    EXPECT_EQ(value_of<double>(element, name), value) << name;
  EXPECT_EQ(value_of<int>(element, "detector"), 0);
  EXPECT_EQ(value_of<int>(element, "refine"), 0);
  EXPECT_EQ(value_of<guint>(element, "interval"), 1U);
  EXPECT_EQ(value_of<guint>(element, "min-contour-size"), 50U);
}

// Loading a preset overrides everything that an earlier preset set.
TEST(EllipseTrackPreset, EachPresetSetsAllThatTheOthersSet) {
  const auto settings_after = [](const std::vector<const char*>& presets) {
    const auto harness = tracker();
    GstElement* element = element_of(harness);
    for (const char* preset : presets) {
      EXPECT_TRUE(gst_preset_load_preset(GST_PRESET(element), preset)) << preset;
    }
    std::map<std::string, double> values;
    for (const char* name : {"max-axis", "max-axis-ratio", "min-probability"}) {
      values[name] = value_of<double>(element, name);
    }
    values["detector"] = value_of<int>(element, "detector");
    values["tracking"] = value_of<int>(element, "tracking");
    values["refine"] = value_of<int>(element, "refine");
    values["min-contour-size"] = value_of<guint>(element, "min-contour-size");
    values["max-processing-time"] =
        static_cast<double>(value_of<guint64>(element, "max-processing-time"));
    values["detect-contour-overlap"] = value_of<double>(element, "detect-contour-overlap");
    return values;
  };
  const std::vector<const char*> ours = {
      "Landing pad", "Pupil", "Small and far", "High frame rate"};
  for (const char* preset : ours) {
    const auto alone = settings_after({preset});
    for (const char* before : ours) EXPECT_EQ(settings_after({before, preset}), alone) << before;
    EXPECT_EQ(settings_after({"Keipour 2021", preset}), alone) << preset;
  }
}

// Whether a preset finds a ring on a uniform picture of 1280 x 1000.
bool finds(const char* preset, const ellipse::Ellipse& ring) {
  const auto harness = tracker("", support::caps_of("GRAY8", 1280, 1000));
  if (preset != nullptr) {
    EXPECT_TRUE(gst_preset_load_preset(GST_PRESET(element_of(harness)), preset));
  }
  const auto picture = support::rendered(support::plain_ring(), ring, 1280, 1000);
  return target_on(push(harness, support::gray_buffer_of(picture))) != nullptr;
}

TEST(EllipseTrackPreset, EachPresetFindsItsTargets) {
  const ellipse::Ellipse near{640.3, 500.2, 450.0, 400.0, 0.4};
  const ellipse::Ellipse far{640.3, 500.2, 7.5, 6.5, 0.4};
  const ellipse::Ellipse flat{640.3, 500.2, 120.0, 45.0, 0.4};
  EXPECT_TRUE(finds(nullptr, near));
  EXPECT_TRUE(finds("Landing pad", near));
  EXPECT_FALSE(finds("Keipour 2021", near));
  EXPECT_TRUE(finds("Small and far", far));
  EXPECT_FALSE(finds(nullptr, far));
  EXPECT_TRUE(finds(nullptr, flat));
  EXPECT_FALSE(finds("Pupil", flat));
  EXPECT_TRUE(finds("High frame rate", flat));
}

TEST(EllipseTrackPreset, InconsistentPresetsChangeNothing) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  BusTap bus(element);
  EXPECT_FALSE(gst_preset_load_preset(GST_PRESET(element), "Turned pair"));
  EXPECT_TRUE(bus.pop(GST_MESSAGE_WARNING));
  EXPECT_EQ(value_of<int>(element, "detector"), 1);
  EXPECT_EQ(value_of<double>(element, "max-axis"), 32768.0);
  g_object_set(element, "max-axis", 600.0, nullptr);  // later values apply as before
  EXPECT_EQ(value_of<double>(element, "max-axis"), 600.0);
  EXPECT_FALSE(gst_preset_load_preset(GST_PRESET(element), "No such preset"));
}

TEST(EllipseTrackPreset, RestoresRegionsAndTimes) {
  const auto harness = tracker();
  GstElement* element = element_of(harness);
  ASSERT_TRUE(gst_preset_load_preset(GST_PRESET(element), "Region"));
  GValue roi = G_VALUE_INIT;
  g_object_get_property(G_OBJECT(element), "roi", &roi);
  gchar* text = gst_value_serialize(&roi);
  EXPECT_STREQ(text, "< (int)10, (int)20, (int)300, (int)200 >");
  g_free(text);
  g_value_unset(&roi);
  gchar* type = value_of<gchar*>(element, "roi-type");
  EXPECT_STREQ(type, "pad");
  g_free(type);
  EXPECT_EQ(value_of<guint64>(element, "max-processing-time"), 20 * GST_MSECOND);
}

}  // namespace
