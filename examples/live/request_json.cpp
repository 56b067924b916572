// SPDX-License-Identifier: MIT
#include "examples/live/request_json.hpp"

#include <cmath>
#include <stdexcept>

namespace live {
namespace {

bool is_text(JsonNode* node) {
  return JSON_NODE_HOLDS_VALUE(node) && json_node_get_value_type(node) == G_TYPE_STRING;
}

}  // namespace

RequestJson::RequestJson(const std::string& body) : parser_(json_parser_new()) {
  GError* problem = nullptr;
  const auto size = static_cast<gssize>(body.size());
  json_parser_load_from_data(parser_.get(), body.c_str(), size, &problem);
  if (problem != nullptr) {
    const Ref<GError> error(problem);
    throw std::invalid_argument(std::string("invalid JSON: ") + error->message);
  }
  JsonNode* root = json_parser_get_root(parser_.get());
  if (root == nullptr || !JSON_NODE_HOLDS_OBJECT(root)) {
    throw std::invalid_argument("expected a JSON object");
  }
  object_ = json_node_get_object(root);
}

JsonNode* RequestJson::node(const char* name) const {
  return json_object_get_member(object_, name);
}

bool RequestJson::has(const char* name) const {
  return node(name) != nullptr;
}

std::string RequestJson::text(const char* name) const {
  JsonNode* member = node(name);
  if (member == nullptr || !is_text(member)) {
    throw std::invalid_argument(std::string(name) + ": expected a string");
  }
  return json_node_get_string(member);
}

double RequestJson::number(const char* name) const {
  JsonNode* member = node(name);
  const bool is_value = member != nullptr && JSON_NODE_HOLDS_VALUE(member);
  const GType type = is_value ? json_node_get_value_type(member) : G_TYPE_INVALID;
  if (type != G_TYPE_INT64 && type != G_TYPE_DOUBLE) {
    throw std::invalid_argument(std::string(name) + ": expected a number");
  }
  const double number = json_node_get_double(member);
  if (std::isfinite(number)) return number;  // JSON allows 1e999
  throw std::invalid_argument(std::string(name) + ": the number is too large");
}

guint64 RequestJson::whole(const char* name) const {
  constexpr double kMax = 9007199254740992.0;
  const double value = number(name);
  if (value >= 0.0 && value <= kMax && value == std::floor(value)) {
    return static_cast<guint64>(value);
  }
  throw std::invalid_argument(std::string(name) + ": expected a whole number");
}

GstClockTime RequestJson::time(const char* name) const {
  constexpr double kLatest = 9e18;
  if (has(name) && is_text(node(name))) {
    // JavaScript numbers are doubles, which cannot represent nanoseconds since 1970 exactly.
    const std::string digits = text(name);
    guint64 time = 0;
    if (g_ascii_string_to_unsigned(digits.c_str(), 10, 0, G_MAXINT64, &time, nullptr)) return time;
  } else if (const double time = number(name); time >= 0.0 && time <= kLatest) {
    return json_node_get_value_type(node(name)) == G_TYPE_INT64
               ? static_cast<GstClockTime>(json_node_get_int(node(name)))
               : static_cast<GstClockTime>(time);
  }
  throw std::invalid_argument(std::string(name) + ": expected a time in ns");
}

}  // namespace live
