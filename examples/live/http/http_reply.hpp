#pragma once  // SPDX-License-Identifier: MIT

#include <libsoup/soup.h>

#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// A complete HTTP reply.
struct Reply {
  int status = 200;
  std::string type = "application/json";
  std::string body;
};

/// A reply with this status and the body `{"error":"..."}`.
[[nodiscard]] Reply error_reply(int status, const std::string& message);

/// Sends a reply. Main loop only.
void answer(SoupServerMessage* message, const Reply& reply);

/// Adds the security headers (content type, referrer, resource and content policy) to a reply.
void add_policy(SoupServerMessage* message);

/// Pauses a request and answers it later. Main loop only.
class LaterReply {
 public:
  explicit LaterReply(SoupServerMessage* message);
  void send(const Reply& reply);

 private:
  Ref<SoupServerMessage> message_;
};

}  // namespace live
