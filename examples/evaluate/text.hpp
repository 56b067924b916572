#pragma once  // SPDX-License-Identifier: MIT

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace evaluate {

/// printf() into a string.
template <class... Values>
[[nodiscard]] std::string format(const char* pattern, const Values&... values) {
  const int length = std::snprintf(nullptr, 0, pattern, values...);
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  std::snprintf(text.data(), text.size(), pattern, values...);
  text.pop_back();
  return text;
}

/// The parts of a text between separators; one empty part for an empty text.
[[nodiscard]] inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// null for NaN, which JSON cannot represent.
[[nodiscard]] inline std::string json_number(double value) {
  return std::isfinite(value) ? format("%.6g", value) : "null";
}

/// A number for output; a dash for NaN.
[[nodiscard]] inline std::string number(double value, int digits) {
  return std::isfinite(value) ? format("%.*f", digits, value) : "-";
}

}  // namespace evaluate
