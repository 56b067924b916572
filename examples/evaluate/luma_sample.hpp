#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <opencv2/core/mat.hpp>

namespace evaluate {

/// A copy of the first plane of a sample of GRAY8 or planar YUV; empty where it cannot be mapped.
[[nodiscard]] cv::Mat luma_of(GstSample* sample);

}  // namespace evaluate
