#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "examples/live/pipeline/source_spec.hpp"

namespace live {

/// A folder of .png or .jpg: those of the kind that most of them are, in the order of their names,
/// 9 before 10. Its gst-launch line names the pictures themselves where their names are numbered,
/// and links them under numbers in a new temporary folder otherwise.
///
/// Throws std::invalid_argument where there is no picture.
[[nodiscard]] SourceSpec folder_source(const std::string& text, FrameRate rate);

}  // namespace live
