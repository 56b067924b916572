#pragma once  // SPDX-License-Identifier: MIT

#include "core/camera/lens_view.hpp"
#include "gst/ellipse/gstellipsemeta.h"

/// Writes the outline of an ellipse's metadata: points around it as the lens distorts them, the
/// ellipse being of the ideal plane. Does nothing without a lens. Thread-safe; allocates nothing.
void write_outline(GstEllipseMeta* meta, const ellipse::LensView& lens);
