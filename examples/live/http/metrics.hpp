#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "examples/live/http/http_server.hpp"
#include "examples/live/session.hpp"

namespace live {

/// The program's metrics in the Prometheus text format 0.0.4.
[[nodiscard]] std::string metrics_text(Session& session, const HttpServer& server);

}  // namespace live
