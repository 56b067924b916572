#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include "core/camera/lens_view.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/image/image_view.hpp"
#include "gst/ellipse/gstellipsemeta.h"

/// The ellipse of metadata [px].
[[nodiscard]] inline ellipse::Ellipse ellipse_of(const GstEllipseMeta& meta) {
  return {meta.cx, meta.cy, meta.semi_major, meta.semi_minor, meta.angle_rad};
}

/// The whole frame of a buffer [px]. With cropping by metadata, the caps have the size of the crop
/// and the buffer's video metadata has that of the frame.
/// @param info  From the caps.
[[nodiscard]] ellipse::Rect frame_of(GstBuffer* buffer, const GstVideoInfo& info);

/// Attaches metadata of an ellipse in the ideal plane [px]: its parameters, its outline in
/// distorted image coordinates if the lens distorts, the frame's size and time stamp. The buffer
/// owns it. One thread at a time; allocates the metadata.
/// @param info  From the caps.
GstEllipseMeta* attach_ellipse(GstBuffer* buffer,
                               GstEllipseRole role,
                               const ellipse::Ellipse& e,
                               const ellipse::LensView& lens,
                               const GstVideoInfo& info);
