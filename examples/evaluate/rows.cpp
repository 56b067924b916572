// SPDX-License-Identifier: MIT
#include "examples/evaluate/rows.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "examples/evaluate/text.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

}  // namespace

Row::Row(const fs::path& file,
         int line,
         const std::vector<std::string>& header,
         std::vector<std::string> fields)
    : file_(file), line_(line), header_(header), fields_(std::move(fields)) {
  if (fields_.size() == header_.size()) return;
  fail(std::to_string(fields_.size()) + " fields, but the header has " +
       std::to_string(header_.size()));
}

std::string Row::location() const {
  return file_.string() + ":" + std::to_string(line_) + ": ";
}

void Row::fail(const std::string& what) const {
  throw RowError(location() + what);
}

bool Row::has(const std::string& column) const {
  return std::find(header_.begin(), header_.end(), column) != header_.end();
}

const std::string& Row::text(const std::string& column) const {
  const auto found = std::find(header_.begin(), header_.end(), column);
  if (found == header_.end()) {
    throw std::runtime_error(file_.string() + ": no column \"" + column + "\"");
  }
  return fields_[static_cast<std::size_t>(found - header_.begin())];
}

double Row::number(const std::string& column) const {
  const std::string& field = text(column);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) {
    fail(column + " is \"" + field + "\", not a number");
  }
  return value;
}

std::optional<double> Row::optional_number(const std::string& column) const {
  if (!has(column) || text(column).empty()) return std::nullopt;
  return number(column);
}

void for_each_row(const fs::path& file,
                  char separator,
                  const std::function<void(const Row&)>& use,
                  const std::function<void(const std::string&)>& skip) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<std::string> header;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (text.empty()) continue;
    if (header.empty()) {
      header = split(text, separator);
      continue;
    }
    try {
      use(Row(file, line, header, split(text, separator)));
    } catch (const RowError& error) {
      skip(error.what());
    }
  }
  if (header.empty()) throw std::runtime_error(file.string() + ": is empty");
}

}  // namespace evaluate
