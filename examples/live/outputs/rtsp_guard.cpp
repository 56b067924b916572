// SPDX-License-Identifier: MIT
#include "examples/live/outputs/rtsp_guard.hpp"

#include <algorithm>

namespace live {
namespace {

constexpr double kMessagesAtOnce = 2.0 * RtspGuard::kMessagesPerSecond;
constexpr std::size_t kDataHeaderBytes = 4;  // "$", channel, length (2 bytes)
constexpr std::size_t kMethodBytes = 5;      // enough to distinguish HTTP from RTSP

}  // namespace

RtspGuard::RtspGuard(RateLimiter::Clock clock)
    : messages_(kMessagesPerSecond, kMessagesAtOnce, clock) {}

bool RtspGuard::take(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const std::uint8_t byte = bytes.front();
    std::size_t taken = 1;
    switch (part_) {
      case Part::kStart:
        if (!begin(byte)) return false;
        break;
      case Part::kLines:
        if (!take_text(byte)) return false;
        break;
      case Part::kDataHeader:
        take_data_header(byte);
        break;
      case Part::kData:
        taken = std::min(data_bytes_, bytes.size());
        data_bytes_ -= taken;
        if (data_bytes_ == 0) part_ = Part::kStart;
        break;
    }
    bytes = bytes.subspan(taken);
  }
  return true;
}

bool RtspGuard::begin(std::uint8_t byte) {
  if (byte == '\r' || byte == '\n') return true;  // allowed between messages
  if (!messages_.take()) return false;
  header_bytes_ = line_bytes_ = 0;
  has_return_ = false;
  method_.clear();
  if (byte == '$') {
    part_ = Part::kDataHeader;
    data_bytes_ = 0;
    header_bytes_ = 1;
    return true;
  }
  part_ = Part::kLines;
  return take_text(byte);
}

bool RtspGuard::take_text(std::uint8_t byte) {
  if (++header_bytes_ > kMaxHeaders) return false;
  const bool is_end = byte == '\n';
  if (has_return_ != is_end) return false;
  has_return_ = byte == '\r';
  if (has_return_) return true;
  if (is_end) {
    if (line_bytes_ == 0) part_ = Part::kStart;
    line_bytes_ = 0;
    return true;
  }
  if (byte < 0x20 && byte != '\t') return false;
  ++line_bytes_;
  if (header_bytes_ <= kMethodBytes) method_ += static_cast<char>(byte);
  return method_ != "GET /" && method_ != "POST ";
}

void RtspGuard::take_data_header(std::uint8_t byte) {
  if (++header_bytes_ > 2) data_bytes_ = data_bytes_ << 8 | byte;
  if (header_bytes_ == kDataHeaderBytes) part_ = data_bytes_ > 0 ? Part::kData : Part::kStart;
}

}  // namespace live
