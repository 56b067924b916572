#pragma once  // SPDX-License-Identifier: MIT

#include "examples/live/http/http_server.hpp"
#include "examples/live/options.hpp"
#include "examples/live/session.hpp"

namespace live {

/// Adds the route that saves labelled snapshots to the folder of --labels, see docs/live.md.
/// Without the option, the route replies with an error. Throws std::runtime_error if the folder
/// cannot be created.
void add_labels(HttpServer& server, Session& session, const Options& options);

}  // namespace live
