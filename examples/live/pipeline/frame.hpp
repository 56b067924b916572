#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// One analysed frame. Immutable after construction, so any thread may read it.
struct Frame {
  Ref<GstSample> sample;  ///< Pixels, caps and metadata.
  Ref<GstBuffer> input;   ///< The tracker's input buffer, without its metadata and overlay.
  guint64 number = 0;     ///< Unique. A second analysis of the same picture has another number.
  guint64 index = 0;      ///< Of the picture, from 0. All analyses of a picture share it.
  GstClockTime pts = 0;   ///< [ns] Identifies the frame to viewers.
  gint64 arrived_us = 0;  ///< Monotonic time at the tracker's input.
  int width = 0;          ///< [px]
  int height = 0;         ///< [px]
  double rate = 0.0;      ///< Frame rate in the caps [1/s]; 0 = unknown.
  std::string line;       ///< JSON line of the ellipses, with the newline.
};

using FramePtr = std::shared_ptr<const Frame>;

/// Makes a frame from the tracker's output. Thread-safe.
/// @param sample  Copied, because appsink 1.22 overwrites its own sample after a flush.
/// @return nullptr if the sample is not video.
[[nodiscard]] FramePtr make_frame(GstSample* sample,
                                  Ref<GstBuffer> input,
                                  guint64 index,
                                  gint64 arrived_us);

/// A copy with its own pixels. It holds no buffer of the source's pool. The pixels are those of the
/// tracker's input, the metadata are those of its output. Thread-safe.
[[nodiscard]] FramePtr detached_copy(const Frame& frame);

}  // namespace live
