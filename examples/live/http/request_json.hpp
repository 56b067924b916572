#pragma once  // SPDX-License-Identifier: MIT

#include <json-glib/json-glib.h>

#include <string>

#include "examples/live/ref.hpp"

namespace live {

/// The JSON object in a request's body. Every function throws std::invalid_argument that names the
/// member that is missing or of another type.
class RequestJson {
 public:
  explicit RequestJson(const std::string& body);
  /// A part of another one, which has to outlive this.
  explicit RequestJson(JsonObject* part) : object_(part) {}

  [[nodiscard]] std::string text(const char* name) const;
  [[nodiscard]] double number(const char* name) const;
  /// A time [ns]: a number, or text of its digits.
  [[nodiscard]] GstClockTime time(const char* name) const;
  [[nodiscard]] bool has(const char* name) const;
  /// Owned by this; null where there is none.
  [[nodiscard]] JsonNode* node(const char* name) const;
  [[nodiscard]] JsonObject* object() const { return object_; }

 private:
  Ref<JsonParser> parser_;
  JsonObject* object_;
};

}  // namespace live
