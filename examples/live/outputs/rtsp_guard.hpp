#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "examples/live/http/security.hpp"

namespace live {

/// Limits a client's input over RTSP by parsing its bytes. gst-rtsp-server itself collects a
/// request's headers without a limit before it requests the password.
///
/// Follows the parser of GstRTSPConnection: requests without a body, and interleaved binary data
/// [RFC 2326, section 10.12]. Input that the two parsers could interpret differently is rejected,
/// because a guard that loses synchronisation limits nothing.
class RtspGuard {
 public:
  /// @param clock  See RateLimiter.
  explicit RtspGuard(RateLimiter::Clock clock = nullptr);

  /// Checks the client's next bytes, in pieces of any size.
  /// @return false if a limit is exceeded or the input is not valid RTSP: headers above kMaxHeaders
  /// bytes, a control character in them, a line that does not end in CR LF, RTSP over HTTP, or more
  /// than kMessagesPerSecond requests and interleaved packets.
  [[nodiscard]] bool take(std::span<const std::uint8_t> bytes);

  static constexpr std::size_t kMaxHeaders = 8192;    ///< All lines of a request together.
  static constexpr double kMessagesPerSecond = 50.0;  ///< RTCP reports arrive every few seconds.

 private:
  enum class Part { kStart, kLines, kDataHeader, kData };

  [[nodiscard]] bool begin(std::uint8_t byte);
  [[nodiscard]] bool take_text(std::uint8_t byte);
  void take_data_header(std::uint8_t byte);

  RateLimiter messages_;
  Part part_ = Part::kStart;
  std::string method_;            // first kMethodBytes of the request
  std::size_t header_bytes_ = 0;  // of this request or packet so far
  std::size_t line_bytes_ = 0;    // of this line, without its end
  std::size_t data_bytes_ = 0;    // of this packet, remaining
  bool has_return_ = false;       // the previous byte was a carriage return
};

}  // namespace live
