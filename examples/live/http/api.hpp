#pragma once  // SPDX-License-Identifier: MIT

#include "examples/live/http/http_server.hpp"
#include "examples/live/options.hpp"
#include "examples/live/session.hpp"

namespace live {

/// Gives the server all that clients may ask of a session: docs/live.md lists it.
/// @param session  Borrowed, as the server is, for as long as it serves.
void add_api(HttpServer& server, Session& session, const Options& options);

}  // namespace live
