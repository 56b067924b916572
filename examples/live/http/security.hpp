#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <string>
#include <string_view>

namespace live {

/// Rate limit with a burst size (token bucket). Not thread-safe.
class RateLimiter {
 public:
  using Clock = std::int64_t (*)();  ///< Monotonic time [us].

  RateLimiter(double per_second, double burst, Clock clock = nullptr);
  /// @return false if the limit is exceeded.
  bool take();

 private:
  double per_second_;
  double burst_;
  double left_;
  Clock clock_;
  std::int64_t last_us_;
};

/// Request headers that identify the requesting site; empty if absent.
struct Origin {
  std::string host;            ///< "Host"
  std::string origin;          ///< "Origin": sent by browsers with writes and WebSockets.
  std::string sec_fetch_site;  ///< "Sec-Fetch-Site": sent by browsers with every request.
};

/// Whether a request comes from a page of another site. Programs other than browsers send neither
/// "Origin" nor "Sec-Fetch-Site" and are accepted.
[[nodiscard]] bool is_foreign(const Origin& origin);

/// Whether a Host header names the loopback interface. Without a token, this check rejects DNS
/// rebinding: pages of other sites whose name resolves to this machine.
[[nodiscard]] bool is_loopback_host(const std::string& host);

/// Whether an address is a loopback address, which accepts connections from this machine only.
[[nodiscard]] bool is_loopback_address(const std::string& address);

/// Generates 32 random hexadecimal digits.
[[nodiscard]] std::string make_token();

/// Compares two secrets in constant time for inputs of the same length.
[[nodiscard]] bool is_same_secret(std::string_view given, std::string_view secret);

}  // namespace live
