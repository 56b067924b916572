#pragma once  // SPDX-License-Identifier: MIT

#include <string>

namespace live {

/// Part of a gst-launch line that encodes raw video as H.264 with low latency, by x264enc or
/// openh264enc. Throws std::runtime_error if neither is installed.
[[nodiscard]] std::string h264_encoder();

}  // namespace live
