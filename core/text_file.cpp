// SPDX-License-Identifier: MIT
#include "core/text_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace ellipse {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

std::string read_text_file(const std::string& path) {
  // Opening a FIFO blocks until its other end is opened.
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw std::invalid_argument(path + ": is not a regular file");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::invalid_argument(path + ": cannot be read");
  std::string text(kMaxTextFile + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, stream.gcount())));
  if (text.size() > kMaxTextFile) throw std::invalid_argument(path + ": is larger than 1 MB");
  if (text.find('\0') != std::string::npos) {
    throw std::invalid_argument(path + ": is not a text file");
  }
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw std::invalid_argument(path + ": is empty");
  }
  return text;
}

}  // namespace ellipse
