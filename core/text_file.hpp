#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <string>

namespace ellipse {

/// Maximum size of a text file [bytes].
inline constexpr std::size_t kMaxTextFile = 1 << 20;

/// The contents of a text file without its byte order mark. Throws std::invalid_argument that names
/// the file if it is not a regular file, cannot be read, is too large, empty, or not text.
[[nodiscard]] std::string read_text_file(const std::string& path);

}  // namespace ellipse
