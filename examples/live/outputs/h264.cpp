// SPDX-License-Identifier: MIT
#include "examples/live/outputs/h264.hpp"

#include <gst/gst.h>

#include <array>
#include <stdexcept>

#include "examples/live/ref.hpp"

namespace live {

std::string h264_encoder() {
  struct Encoder {
    const char* name;
    const char* settings;
  };
  constexpr std::array kEncoders = {
      Encoder{"x264enc", "tune=zerolatency speed-preset=veryfast bitrate=4000 key-int-max=30"},
      Encoder{"openh264enc", "complexity=low bitrate=4000000 gop-size=30"},
  };
  for (const Encoder& encoder : kEncoders) {
    const Ref<GstElementFactory> factory(gst_element_factory_find(encoder.name));
    if (!factory) continue;
    return std::string("videoconvert ! video/x-raw,format=I420 ! ") + encoder.name + " " +
           encoder.settings;
  }
  throw std::runtime_error("no H.264 encoder is installed: neither x264enc nor openh264enc");
}

}  // namespace live
