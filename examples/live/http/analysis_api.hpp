#pragma once  // SPDX-License-Identifier: MIT

#include "examples/live/http/http_server.hpp"
#include "examples/live/session.hpp"

namespace live {

/// Adds /api/analyze, for the shown frame, and /api/history/replay, for stored frames. Borrows the
/// session, which must exist while the main loop runs.
void add_analysis(HttpServer& server, Session& session);

}  // namespace live
