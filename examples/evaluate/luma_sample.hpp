#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <opencv2/core/mat.hpp>

namespace evaluate {

/// Copies the first plane of a GRAY8 or planar YUV sample; empty if it cannot be mapped.
[[nodiscard]] cv::Mat luma_of(GstSample* sample);

}  // namespace evaluate
