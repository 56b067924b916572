#pragma once  // SPDX-License-Identifier: MIT

#include <libsoup/soup.h>

#include <map>
#include <string>
#include <utility>

#include "examples/live/http/security.hpp"

namespace live {

/// The checks that concern every request: who asks, from where, how often, how much. For the main
/// loop's thread.
class HttpGate {
 public:
  /// @param token  Empty = none is asked for, and clients are on this machine.
  explicit HttpGate(std::string token) : token_(std::move(token)) {}

  /// Answers what may not pass, and the link with the token, which it makes a cookie of.
  /// @return Whether the request was refused.
  bool refuses(SoupServerMessage* message, const std::string& path);

 private:
  [[nodiscard]] bool has_token(SoupServerMessage* message) const;
  bool take_token_from_link(SoupServerMessage* message, const std::string& path) const;
  bool may_ask_now(SoupServerMessage* message);

  std::string token_;
  std::map<std::string, Allowance> allowances_;  // by the client's address
};

}  // namespace live
