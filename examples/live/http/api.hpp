#pragma once  // SPDX-License-Identifier: MIT

#include "examples/live/http/http_server.hpp"
#include "examples/live/options.hpp"
#include "examples/live/session.hpp"

namespace live {

/// Adds the HTTP interface of a session to the server, as listed in docs/live.md.
/// @param session  Borrowed; must exist while the main loop runs.
void add_api(HttpServer& server, Session& session, const Options& options);

}  // namespace live
