// SPDX-License-Identifier: MIT
#include "examples/live/json_writer.hpp"

#include <glib.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace live {

void JsonWriter::separate() {
  if (needs_comma_) text_ += ',';
  needs_comma_ = true;
}

JsonWriter& JsonWriter::open(char bracket) {
  separate();
  text_ += bracket;
  needs_comma_ = false;
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  text_ += bracket;
  needs_comma_ = true;
  return *this;
}

JsonWriter& JsonWriter::raw(std::string_view json) {
  separate();
  text_ += json;
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  append_quoted(name);
  text_ += ':';
  needs_comma_ = false;
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  append_quoted(text);
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  if (!std::isfinite(number)) return null();
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  return raw(std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
}

void JsonWriter::append_quoted(std::string_view text) {
  gchar* valid = g_utf8_make_valid(text.data(), static_cast<gssize>(text.size()));
  text_ += '"';
  for (const char* c = valid; *c != '\0'; ++c) {
    if (*c == '"' || *c == '\\') {
      text_ += '\\';
      text_ += *c;
    } else if (static_cast<unsigned char>(*c) < 0x20) {
      std::array<char, 8> code;
      std::snprintf(code.data(), code.size(), "\\u%04x", static_cast<unsigned>(*c));
      text_ += code.data();
    } else {
      text_ += *c;
    }
  }
  text_ += '"';
  g_free(valid);
}

std::string json_number(double value) {
  return JsonWriter().value(value).text();
}

std::string error_json(std::string_view message) {
  return JsonWriter().begin_object().member("error", message).end_object().text() + "\n";
}

}  // namespace live
