#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "examples/live/pipeline/properties.hpp"
#include "examples/live/pipeline/source_spec.hpp"

namespace live {

/// A shell command that runs the same source with the same settings and shows the result on the
/// screen.
[[nodiscard]] std::string launch_line(const SourceSpec& source, const Properties& properties);

}  // namespace live
