#pragma once  // SPDX-License-Identifier: MIT

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>

namespace live {

/// Writes JSON text sequentially. Numbers have the shortest form that round-trips, in every locale;
/// non-finite numbers become null.
class JsonWriter {
 public:
  JsonWriter& begin_object() { return open('{'); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& begin_array() { return open('['); }
  JsonWriter& end_array() { return close(']'); }
  JsonWriter& key(std::string_view name);

  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(double number);
  JsonWriter& value(bool claim) { return raw(claim ? "true" : "false"); }
  template <std::integral Number>
  JsonWriter& value(Number number) {
    return raw(std::to_string(number));
  }
  JsonWriter& null() { return raw("null"); }
  /// Appends text that already is JSON.
  JsonWriter& raw(std::string_view json);

  /// Appends a key and its value.
  template <class Value>
  JsonWriter& member(std::string_view name, const Value& content) {
    return key(name).value(content);
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);
  void separate();
  void append_quoted(std::string_view text);

  std::string text_;
  bool needs_comma_ = false;
};

/// A number as JSON text.
[[nodiscard]] std::string json_number(double value);

/// The object {"error": message}.
[[nodiscard]] std::string error_json(std::string_view message);

}  // namespace live
