#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <span>

#include "examples/live/http/security.hpp"

namespace live {

/// Limits a client's input over a WebSocket by parsing its frames [RFC 6455, section 5.2].
/// libsoup itself collects the fragments of a message without a limit and answers every ping.
class FrameGuard {
 public:
  /// @param clock  See RateLimiter.
  explicit FrameGuard(RateLimiter::Clock clock = nullptr);

  /// Checks the client's next bytes, in pieces of any size.
  /// @return false if a limit is exceeded: kMaxMessage bytes for all fragments of a message,
  /// kFramesPerSecond, or kControlsPerSecond for pings, pongs and closes together.
  [[nodiscard]] bool take(std::span<const std::uint8_t> bytes);

  static constexpr std::uint64_t kMaxMessage = 1024;  ///< An acknowledgement has about 30 bytes.
  static constexpr double kFramesPerSecond = 250.0;   ///< Four times the acknowledgements at 60 Hz.
  static constexpr double kControlsPerSecond = 1.0;   ///< Clients ping about every 20 s.

 private:
  [[nodiscard]] bool take_header_byte(std::uint8_t byte);
  [[nodiscard]] bool begin_payload();

  RateLimiter frames_;
  RateLimiter controls_;
  std::uint8_t opcode_ = 0;
  bool is_last_ = false;              // last fragment of its message
  std::size_t header_bytes_ = 0;      // of this frame's header so far
  std::size_t length_bytes_ = 0;      // of the extended length, remaining
  std::size_t mask_bytes_ = 0;        // remaining
  std::uint64_t payload_length_ = 0;  // from the header
  std::uint64_t payload_ = 0;         // remaining
  std::uint64_t message_ = 0;         // all fragments of this message so far
};

}  // namespace live
