#pragma once  // SPDX-License-Identifier: MIT

#include "core/camera/lens_view.hpp"
#include "gst/ellipse/gstellipsemeta.h"

/// Writes `outline` of an ellipse's metadata: points on the undistorted ellipse, in distorted image
/// coordinates. Does nothing without a distorting lens. Thread-safe; allocates nothing.
void write_outline(GstEllipseMeta* meta, const ellipse::LensView& lens);
