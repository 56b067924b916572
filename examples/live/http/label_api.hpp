#pragma once  // SPDX-License-Identifier: MIT

#include "examples/live/http/http_server.hpp"
#include "examples/live/options.hpp"
#include "examples/live/session.hpp"

namespace live {

/// Lets clients write labelled snapshots into the folder for them, where there is one. See
/// docs/live.md.
void add_labels(HttpServer& server, Session& session, const Options& options);

}  // namespace live
