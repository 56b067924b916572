#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// One analysed frame, never changed after it was made: any thread may read it.
struct Frame {
  Ref<GstSample> sample;  ///< Its pixels, caps and metadata.
  Ref<GstBuffer> input;   ///< As it came to the tracker: without its metadata and its drawing.
  guint64 number = 0;     ///< Its own: another analysis of the same picture is another frame.
  guint64 index = 0;      ///< Counts the pictures of this run of the program, from 0.
  GstClockTime pts = 0;   ///< [ns] What viewers know it by.
  gint64 arrived_us = 0;  ///< When the source handed it over, of the monotonic clock.
  int width = 0;          ///< [px]
  int height = 0;         ///< [px]
  double rate = 0.0;      ///< Frames per second that the caps promise; 0 = they do not.
  std::string line;       ///< The JSON line of its ellipses, with the newline.
};

using FramePtr = std::shared_ptr<const Frame>;

/// Makes a frame of what a tracker has handed on. Any thread.
/// @param theirs  Copied: appsink 1.22 writes on its own sample after a flush without asking who
///                else holds it.
/// @return null where it is no video.
[[nodiscard]] FramePtr make_frame(GstSample* theirs,
                                  Ref<GstBuffer> input,
                                  guint64 index,
                                  gint64 arrived_us);

}  // namespace live
