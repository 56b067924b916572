#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <bit>
#include <cstdint>
#include <mutex>
#include <ostream>
#include <string>
#include <vector>

#include "tests/gst/support.hpp"

namespace support {

/// ellipsetrack's result for a frame, compared bit for bit.
struct Verdict {
  GstClockTime pts = GST_CLOCK_TIME_NONE;
  std::uint64_t id = 0;  ///< 0 if nothing was found.
  GstEllipseState state = GST_ELLIPSE_STATE_DETECTED;
  std::array<std::uint64_t, 8> bits{};  ///< The metadata's doubles.
  std::array<std::int64_t, 5> search{};

  [[nodiscard]] double cx() const { return std::bit_cast<double>(bits[0]); }
  [[nodiscard]] double cy() const { return std::bit_cast<double>(bits[1]); }
  bool operator==(const Verdict&) const = default;
};

inline std::ostream& operator<<(std::ostream& out, const Verdict& verdict) {
  out << "pts " << verdict.pts << " id " << verdict.id << " state " << verdict.state;
  for (const std::uint64_t bits : verdict.bits) out << ' ' << std::bit_cast<double>(bits);
  return out;
}

inline Verdict verdict_on(GstBuffer* buffer) {
  Verdict verdict{.pts = GST_BUFFER_PTS(buffer)};
  const GstEllipseMeta* meta = gst_buffer_get_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  if (meta == nullptr) return verdict;
  verdict.id = meta->id;
  verdict.state = meta->state;
  const std::array<double, 8> values{meta->cx,
                                     meta->cy,
                                     meta->semi_major,
                                     meta->semi_minor,
                                     meta->angle_rad,
                                     meta->contour_overlap,
                                     meta->ellipse_overlap,
                                     meta->visible_fraction};
  verdict.bits = std::bit_cast<std::array<std::uint64_t, 8>>(values);
  verdict.search = {
      meta->scale, meta->roi_x, meta->roi_y, int(meta->roi_width), int(meta->roi_height)};
  return verdict;
}

/// Records the results that reach an element's sink pad since the last flush.
class Verdicts {
 public:
  /// Must outlive the pipeline's stream.
  void watch(GstElement* pipeline, const char* name = "out") {
    GstElement* element = gst_bin_get_by_name(GST_BIN(pipeline), name);
    GstPad* pad = gst_element_get_static_pad(element, "sink");
    const auto what =
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BUFFER | GST_PAD_PROBE_TYPE_EVENT_FLUSH);
    gst_pad_add_probe(pad, what, note, this, nullptr);
    gst_object_unref(pad);
    gst_object_unref(element);
  }
  [[nodiscard]] std::vector<Verdict> all() const {
    const std::lock_guard lock(mutex_);
    return all_;
  }

 private:
  static GstPadProbeReturn note(GstPad*, GstPadProbeInfo* info, gpointer data) {
    auto* self = static_cast<Verdicts*>(data);
    const std::lock_guard lock(self->mutex_);
    if ((info->type & GST_PAD_PROBE_TYPE_BUFFER) != 0) {
      self->all_.push_back(verdict_on(GST_PAD_PROBE_INFO_BUFFER(info)));
    } else {
      self->all_.clear();
    }
    return GST_PAD_PROBE_OK;
  }

  mutable std::mutex mutex_;
  std::vector<Verdict> all_;
};

/// The results of a pipeline that ends in an element named "out"; none on failure.
inline std::vector<Verdict> verdicts_of(const std::string& pipeline) {
  Verdicts verdicts;
  const std::string failure =
      run_pipeline(pipeline, [&](GstElement* element) { verdicts.watch(element); });
  return failure.empty() ? verdicts.all() : std::vector<Verdict>{};
}

}  // namespace support
