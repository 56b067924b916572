#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "examples/live/pipeline/source_spec.hpp"

namespace live {

/// Makes a source of the .png or .jpg pictures in a folder. If both types exist, the more frequent
/// one is used. Pictures are in natural order of their names: 9 before 10. The gst-launch line
/// names the files themselves if their names are numbered; otherwise it links them under numbers in
/// a temporary folder.
///
/// Throws std::invalid_argument if the folder has no picture.
[[nodiscard]] SourceSpec folder_source(const std::string& text, FrameRate rate);

}  // namespace live
