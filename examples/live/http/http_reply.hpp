#pragma once  // SPDX-License-Identifier: MIT

#include <libsoup/soup.h>

#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// What a client is told.
struct Reply {
  int status = 200;
  std::string type = "application/json";
  std::string body;
};

/// `{"error":"..."}` with this status.
[[nodiscard]] Reply error_reply(int status, const std::string& message);

/// Answers a request. For the main loop's thread.
void answer(SoupServerMessage* message, const Reply& reply);

/// Says with a reply what a browser may do with all that comes from here.
void add_policy(SoupServerMessage* message);

/// Answers a request later. For the main loop's thread.
class LaterReply {
 public:
  explicit LaterReply(SoupServerMessage* message);
  void send(const Reply& reply);

 private:
  Ref<SoupServerMessage> message_;
};

}  // namespace live
