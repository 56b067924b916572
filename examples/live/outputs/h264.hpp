#pragma once  // SPDX-License-Identifier: MIT

#include <string>

namespace live {

/// The part of a gst-launch line that encodes raw video as H.264, at once rather than well: the
/// first encoder that is installed of x264enc, openh264enc. Throws std::runtime_error where none
/// is.
[[nodiscard]] std::string h264_encoder();

}  // namespace live
