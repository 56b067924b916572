// SPDX-License-Identifier: MIT
#include "examples/live/http/frame_guard.hpp"

#include <algorithm>

namespace live {
namespace {

constexpr double kFramesAtOnce = 2.0 * FrameGuard::kFramesPerSecond;
constexpr double kControlsAtOnce = 20.0;
constexpr std::size_t kMaskBytes = 4;

}  // namespace

FrameGuard::FrameGuard(RateLimiter::Clock clock)
    : frames_(kFramesPerSecond, kFramesAtOnce, clock),
      controls_(kControlsPerSecond, kControlsAtOnce, clock) {}

bool FrameGuard::take(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    if (payload_ > 0) {
      const auto skipped =
          static_cast<std::size_t>(std::min<std::uint64_t>(payload_, bytes.size()));
      payload_ -= skipped;
      bytes = bytes.subspan(skipped);
      continue;
    }
    if (!take_header_byte(bytes.front())) return false;
    bytes = bytes.subspan(1);
  }
  return true;
}

bool FrameGuard::take_header_byte(std::uint8_t byte) {
  if (header_bytes_ == 0) {
    is_last_ = (byte & 0x80) != 0;
    opcode_ = byte & 0x0f;
    payload_length_ = 0;
  } else if (header_bytes_ == 1) {
    const std::uint8_t length = byte & 0x7f;
    length_bytes_ = length == 126 ? 2 : length == 127 ? 8 : 0;
    if (length_bytes_ == 0) payload_length_ = length;
    mask_bytes_ = (byte & 0x80) != 0 ? kMaskBytes : 0;
  } else if (length_bytes_ > 0) {
    payload_length_ = payload_length_ << 8 | byte;
    --length_bytes_;
  } else {
    --mask_bytes_;
  }
  ++header_bytes_;
  return header_bytes_ == 1 || length_bytes_ > 0 || mask_bytes_ > 0 || begin_payload();
}

// Called when the header is complete.
bool FrameGuard::begin_payload() {
  header_bytes_ = 0;
  const bool is_control = opcode_ >= 8;
  if (!(is_control ? controls_ : frames_).take()) return false;
  if (payload_length_ > kMaxMessage) return false;
  payload_ = payload_length_;
  if (is_control) return true;  // control frames may be interleaved with the fragments of a message
  message_ += payload_length_;
  if (message_ > kMaxMessage) return false;
  if (is_last_) message_ = 0;
  return true;
}

}  // namespace live
