#pragma once  // SPDX-License-Identifier: MIT

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/gst/support.hpp"

namespace support {

/// The ring in most of these tests.
inline constexpr ellipse::Ellipse kRing{150.0, 110.0, 50.0, 35.0, 0.4};

inline GrayPicture ring_picture(int width = 320, int height = 240) {
  return rendered(plain_ring(), kRing, width, height);
}

/// An ellipsetrack between two test pads.
inline Owned<GstHarness> tracker(const std::string& settings = "",
                                 const std::string& caps = caps_of("GRAY8", 320, 240)) {
  return harness_of("ellipsetrack name=t " + settings, caps, caps);
}

/// The element inside the bin that gst_harness_new_parse makes. The harness owns it.
inline GstElement* element_of(const Owned<GstHarness>& harness) {
  GstElement* found = GST_IS_BIN(harness->element)
                          ? gst_bin_get_by_name(GST_BIN(harness->element), "t")
                          : GST_ELEMENT(gst_object_ref(harness->element));
  gst_object_unref(found);
  return found;
}

inline Owned<GstBuffer> push(const Owned<GstHarness>& harness, Owned<GstBuffer> buffer) {
  return Owned<GstBuffer>(gst_harness_push_and_pull(harness.get(), buffer.release()));
}

inline GstEllipseMeta* target_on(const Owned<GstBuffer>& buffer) {
  return gst_buffer_get_ellipse_meta(buffer.get(), GST_ELLIPSE_ROLE_TARGET);
}

/// The caller owns the result; nullptr if the property has no value.
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
