// SPDX-License-Identifier: MIT
//
// Whole elements from buffer to buffer, beside edges and contours alone. The row "identity" is what
// the pads and the harness around an element cost.
#include <gst/check/gstharness.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/tracker_settings.hpp"
#include "gst/ellipse/gstellipsemeta.h"
#include "tests/bench/allocations.hpp"
#include "tests/bench/frames.hpp"
#include "tests/gst/support.hpp"

namespace {

using bench::Frame;
using bench::Work;
using benchmark::State;
using support::Owned;
using Frames = std::vector<Frame>;

constexpr const char* kFormats[] = {"GRAY8", "I420", "BGR"};

std::vector<Owned<GstBuffer>> buffers_of(const Frames& frames, const std::string& format) {
  std::vector<Owned<GstBuffer>> buffers;
  for (const Frame& frame : frames) {
    const support::Picture& picture = frame.picture;
    buffers.push_back(
        support::buffer_of(picture, support::info_of(format, picture.width, picture.height)));
  }
  return buffers;
}

Owned<GstHarness> harness_of(const std::string& element, const std::string& caps) {
  Owned<GstHarness> harness(gst_harness_new_parse(element.c_str()));
  gst_harness_set_caps_str(harness.get(), caps.c_str(), caps.c_str());
  return harness;
}

// Each frame travels in a new buffer around memory that is there already, as from a camera's pool.
void run_element(State& state,
                 const Frames& frames,
                 const std::string& element,
                 const std::string& format) {
  const std::vector<Owned<GstBuffer>> buffers = buffers_of(frames, format);
  const support::Picture& picture = frames.front().picture;
  const std::string caps = support::caps_of(format, picture.width, picture.height);
  bench::FoundShare found;
  bench::compare(state, frames, [&]() -> Work {
    const std::shared_ptr<GstHarness> harness(harness_of(element, caps));
    return [&, harness, frame = guint64{0}](std::size_t i) mutable {
      GstBuffer* buffer = gst_buffer_copy(buffers[i].get());
      GST_BUFFER_PTS(buffer) = gst_util_uint64_scale(frame++, GST_SECOND, 30);
      const Owned<GstBuffer> out(gst_harness_push_and_pull(harness.get(), buffer));
      found.add(gst_buffer_get_ellipse_meta(out.get(), GST_ELLIPSE_ROLE_TARGET) != nullptr);
    };
  });
  found.report(state);
}

void add_element(const std::string& name, const std::string& element, const std::string& format) {
  bench::add_benchmark(name, [element, format](State& state, const Frames& frames) {
    run_element(state, frames, element, format);
  });
}

void add_elements() {
  add_element("identity", "identity", "GRAY8");
  for (const char* detector : ellipse::detector_nicks()) {
    for (const char* tracking : ellipse::tracking_nicks()) {
      const std::string element =
          std::string("ellipsetrack detector=") + detector + " tracking=" + tracking;
      for (const char* format : kFormats) {
        add_element(std::string("ellipsetrack/") + detector + "/" + tracking + "/" + format,
                    element,
                    format);
      }
    }
  }
}

// Before 2.76 GLib keeps small pieces to itself, and the heap would seem to be at rest.
bool counts_slices() {
  const bench::HeapMeter meter;
  for (int i = 0; i < 2; ++i) g_slice_free1(64, g_slice_alloc(64));
  return meter.allocations() == 2;
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  if (!counts_slices()) {
    std::fputs("GLib's slices are not counted: run with G_SLICE=always-malloc.\n", stderr);
    return 1;
  }
  add_elements();
  return bench::run_benchmarks(argc, argv);
}
