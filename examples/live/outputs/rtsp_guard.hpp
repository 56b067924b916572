#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "examples/live/http/security.hpp"

namespace live {

/// What a client may send over RTSP, checked on the bytes themselves: gst-rtsp-server keeps the
/// headers of a request without a bound, before it asks for a password.
///
/// Follows the parser of GStreamer's GstRTSPConnection: requests without a body, and interleaved
/// binary data [RFC 2326, section 10.12]. What the two could read differently is refused: a
/// parser that has lost its place limits nothing.
class RtspGuard {
 public:
  /// @param clock  As that of Allowance.
  explicit RtspGuard(Allowance::Clock clock = nullptr);

  /// The next bytes of the client, in any pieces.
  /// @return false where there is too much, or what no client of RTSP sends: headers of more than
  /// kMaxHeaders bytes, a control character in them, a line that does not end in CR LF, RTSP
  /// through HTTP, or more requests and interleaved packets than kMessagesPerSecond.
  [[nodiscard]] bool take(std::span<const std::uint8_t> bytes);

  static constexpr std::size_t kMaxHeaders = 8192;    ///< All lines of a request.
  static constexpr double kMessagesPerSecond = 50.0;  ///< RTCP reports come every few seconds.

 private:
  enum class Part { kStart, kLines, kDataHeader, kData };

  [[nodiscard]] bool begin(std::uint8_t byte);
  [[nodiscard]] bool take_text(std::uint8_t byte);
  void take_data_header(std::uint8_t byte);

  Allowance messages_;
  Part part_ = Part::kStart;
  std::string method_;            // the first letters of a request, and no more
  std::size_t header_bytes_ = 0;  // of this request or packet, so far
  std::size_t line_bytes_ = 0;    // of this line, without its end
  std::size_t data_bytes_ = 0;    // of this packet, yet to come
  bool has_return_ = false;       // the last byte was a carriage return
};

}  // namespace live
