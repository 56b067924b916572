#pragma once  // SPDX-License-Identifier: MIT

#include <gtest/gtest.h>

#include <string>

#include "tests/gst/support.hpp"

/// What the tests of ellipsetrack have in common: one tracker, one ring, and what it tells.
namespace support {

inline const ellipse::Ellipse kRing{150.0, 110.0, 50.0, 35.0, 0.4};

inline Picture ring_picture(int width = 320, int height = 240) {
  return rendered(plain_ring(), kRing, width, height);
}

inline Owned<GstHarness> tracker(const std::string& settings = "",
                                 const std::string& caps = caps_of("GRAY8", 320, 240)) {
  Owned<GstHarness> harness(gst_harness_new_parse(("ellipsetrack name=t " + settings).c_str()));
  gst_harness_set_caps_str(harness.get(), caps.c_str(), caps.c_str());
  return harness;
}

// The element itself: gst_harness_new_parse wraps it in a bin.
inline GstElement* element_of(const Owned<GstHarness>& harness) {
  GstElement* found = GST_IS_BIN(harness->element)
                          ? gst_bin_get_by_name(GST_BIN(harness->element), "t")
                          : GST_ELEMENT(gst_object_ref(harness->element));
  gst_object_unref(found);  // the harness keeps it
  return found;
}

inline Owned<GstBuffer> push(const Owned<GstHarness>& harness, Owned<GstBuffer> buffer) {
  return Owned<GstBuffer>(gst_harness_push_and_pull(harness.get(), buffer.release()));
}

inline GstEllipseMeta* target_on(const Owned<GstBuffer>& buffer) {
  return gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET);
}

inline GstStructure* structure_property(GstElement* element, const char* name) {
  GstStructure* structure = nullptr;
  g_object_get(element, name, &structure, nullptr);
  return structure;
}

inline guint64 stat(GstElement* element, const char* name) {
  const Owned<GstStructure> stats(structure_property(element, "stats"));
  guint64 value = 0;
  EXPECT_TRUE(gst_structure_get_uint64(stats.get(), name, &value)) << name;
  return value;
}

}  // namespace support
