#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <string>
#include <string_view>

namespace live {

/// So many things a second, and a store of some more for those who were quiet. Not thread-safe.
class Allowance {
 public:
  using Clock = std::int64_t (*)();  ///< [us], and never goes back.

  Allowance(double per_second, double most, Clock clock = nullptr);
  /// @return false where it is used up.
  bool take();

 private:
  double per_second_;
  double most_;
  double left_;
  Clock clock_;
  std::int64_t last_us_;
};

/// What of a request says where it comes from; empty where it says nothing.
struct Origin {
  std::string host;            ///< "Host"
  std::string origin;          ///< "Origin": browsers send it with writes and WebSockets.
  std::string sec_fetch_site;  ///< "Sec-Fetch-Site": browsers send it with everything.
};

/// Whether a page of another site is behind a request. A program sends neither "Origin" nor
/// "Sec-Fetch-Site", and is none.
[[nodiscard]] bool is_foreign(const Origin& origin);

/// Whether the name that a client used for this machine is the machine itself. Without a token this
/// keeps out pages of other sites whose name was made to point here.
[[nodiscard]] bool is_loopback_host(const std::string& host);

/// Whether an address to listen at is reached from this machine alone.
[[nodiscard]] bool is_loopback_address(const std::string& address);

/// 32 hexadecimal digits from the system's random numbers.
[[nodiscard]] std::string make_token();

/// Whether two secrets are the same. Takes as long for any two of the same length.
[[nodiscard]] bool is_same_secret(std::string_view given, std::string_view secret);

}  // namespace live
