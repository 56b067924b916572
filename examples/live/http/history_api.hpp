#pragma once  // SPDX-License-Identifier: MIT

#include "examples/live/http/http_server.hpp"
#include "examples/live/session.hpp"

namespace live {

/// Adds /api/history: stores, lists and shows the last frames. Borrows the session, which must
/// exist while the main loop runs.
void add_history(HttpServer& server, Session& session);

}  // namespace live
