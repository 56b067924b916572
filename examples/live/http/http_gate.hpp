#pragma once  // SPDX-License-Identifier: MIT

#include <libsoup/soup.h>

#include <map>
#include <string>
#include <utility>

#include "examples/live/http/security.hpp"

namespace live {

/// Checks every request: rate, Host and Origin, size, token. Main loop only.
class HttpGate {
 public:
  /// @param token  Empty = no token required, and only local clients are accepted.
  explicit HttpGate(std::string token) : token_(std::move(token)) {}

  /// Checks a request. Replies if it rejects the request, and if the request exchanges the link's
  /// token for a cookie.
  /// @return Whether the request was rejected.
  bool refuses(SoupServerMessage* message, const std::string& path);

 private:
  [[nodiscard]] bool has_token(SoupServerMessage* message) const;
  bool take_token_from_link(SoupServerMessage* message, const std::string& path) const;
  bool is_within_rate(SoupServerMessage* message);

  std::string token_;
  std::map<std::string, RateLimiter> limiters_;  // by client address
};

}  // namespace live
