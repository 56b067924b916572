#pragma once  // SPDX-License-Identifier: MIT

#include <json-glib/json-glib.h>

#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// The JSON object in a request's body. All functions throw std::invalid_argument that names a
/// member that is missing or has the wrong type.
class RequestJson {
 public:
  explicit RequestJson(const std::string& body);
  /// A nested object, borrowed from another RequestJson.
  explicit RequestJson(JsonObject* part) : object_(part) {}

  [[nodiscard]] std::string text(const char* name) const;
  [[nodiscard]] double number(const char* name) const;
  /// A whole number from 0 to 2^53; doubles represent all of them exactly.
  [[nodiscard]] guint64 whole(const char* name) const;
  /// A time [ns], as a number or a string of digits.
  [[nodiscard]] GstClockTime time(const char* name) const;
  [[nodiscard]] bool has(const char* name) const;
  /// Borrowed; null if the member is missing.
  [[nodiscard]] JsonNode* node(const char* name) const;
  [[nodiscard]] JsonObject* object() const { return object_; }

 private:
  Ref<JsonParser> parser_;
  JsonObject* object_;
};

}  // namespace live
