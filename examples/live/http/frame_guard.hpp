#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <span>

#include "examples/live/http/security.hpp"

namespace live {

/// What a client may send over a WebSocket, checked on the frames themselves [RFC 6455,
/// section 5.2]: a library collects the fragments of a message without a bound, and answers every
/// ping.
class FrameGuard {
 public:
  /// @param clock  As that of Allowance.
  explicit FrameGuard(Allowance::Clock clock = nullptr);

  /// The next bytes of the client, in any pieces.
  /// @return false where there is too much: a message of more than kMaxMessage bytes in all of its
  /// fragments, more frames than kFramesPerSecond, or more pings, pongs and closings than
  /// kControlsPerSecond.
  [[nodiscard]] bool take(std::span<const std::uint8_t> bytes);

  static constexpr std::uint64_t kMaxMessage = 1024;  ///< An acknowledgement has some 30 bytes.
  static constexpr double kFramesPerSecond =
      250.0;  ///< Four acknowledgements for each picture at 60 Hz.
  static constexpr double kControlsPerSecond = 1.0;  ///< Clients ping every 20 s or so.

 private:
  [[nodiscard]] bool take_header_byte(std::uint8_t byte);
  [[nodiscard]] bool begin_payload();

  Allowance frames_;
  Allowance controls_;
  std::uint8_t opcode_ = 0;
  bool is_last_ = false;              // of its message's fragments
  std::size_t header_bytes_ = 0;      // of this frame's header, so far
  std::size_t length_bytes_ = 0;      // of its extended length, yet to come
  std::size_t mask_bytes_ = 0;        // yet to come
  std::uint64_t payload_length_ = 0;  // as the header says
  std::uint64_t payload_ = 0;         // yet to come
  std::uint64_t message_ = 0;         // in the fragments of this message so far
};

}  // namespace live
