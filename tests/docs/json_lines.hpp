#pragma once  // SPDX-License-Identifier: MIT

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "tests/gst/support.hpp"

namespace recipes {

/// The fields of a JSON line, of its last target.
struct JsonLine {
  double pts_ns = -1.0;
  bool has_target = false;
  double cx = 0.0;
  double cy = 0.0;
};

/// Parses the lines of a pipeline's output; fails the test at a line that is not JSON.
inline std::vector<JsonLine> json_lines_of(const std::string& text) {
  std::vector<JsonLine> lines;
  for (const auto& parsed : support::parse_ndjson(std::istringstream(text))) {
    JsonObject* object = support::object_of(parsed);
    EXPECT_NE(object, nullptr) << "line " << lines.size() << " is no JSON: " << text;
    if (object == nullptr) return lines;
    JsonLine line;
    JsonNode* pts = json_object_get_member(object, "pts_ns");
    if (!JSON_NODE_HOLDS_NULL(pts)) line.pts_ns = json_node_get_double(pts);
    JsonArray* targets = json_object_get_array_member(object, "targets");
    for (guint i = 0; i < json_array_get_length(targets); ++i) {
      JsonObject* one = json_array_get_object_element(targets, i);
      if (std::string(json_object_get_string_member(one, "role")) != "target") continue;
      line.has_target = true;
      line.cx = json_object_get_double_member(one, "cx");
      line.cy = json_object_get_double_member(one, "cy");
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace recipes
