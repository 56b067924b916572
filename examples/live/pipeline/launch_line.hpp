#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "examples/live/pipeline/properties.hpp"
#include "examples/live/pipeline/source_spec.hpp"

namespace live {

/// A command for a shell that runs the same source and the same settings, and shows the result on a
/// screen.
[[nodiscard]] std::string launch_line(const SourceSpec& source, const Properties& properties);

}  // namespace live
