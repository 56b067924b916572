// SPDX-License-Identifier: MIT
#include "examples/live/http/label_api.hpp"

#include <json-glib/json-glib.h>

#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "examples/live/json_writer.hpp"
#include "examples/live/outputs/label_store.hpp"
#include "examples/live/request_json.hpp"
#include "gst/meta_ellipse.hpp"

namespace live {
namespace {

ellipse::Ellipse shown_ellipse(const Frame& frame, double index) {
  GstBuffer* buffer = gst_sample_get_buffer(frame.sample.get());
  gpointer state = nullptr;
  double number = 0.0;
  while (const GstEllipseMeta* meta = gst_buffer_iterate_ellipse_meta(buffer, &state)) {
    if (number++ != index) continue;
    return ellipse_of(*meta);
  }
  throw std::invalid_argument("choice: the frame has no ellipse with this number");
}

ellipse::Ellipse drawn_ellipse(const RequestJson& json) {
  const ellipse::Ellipse e{json.number("cx"),
                           json.number("cy"),
                           json.number("semi_major"),
                           json.number("semi_minor"),
                           std::remainder(json.number("angle_rad"), M_PI)};
  const bool is_one = e.semi_major >= e.semi_minor && e.semi_minor > 0.0 &&
                      std::abs(e.cx) + std::abs(e.cy) + e.semi_major < 1e5;
  if (!is_one) throw std::invalid_argument("choice: the axes must be major >= minor > 0 [px]");
  return e;
}

// The choice: an index into the frame's ellipses, an ellipse, or "none".
std::optional<ellipse::Ellipse> chosen(const RequestJson& json, const Frame& frame) {
  JsonNode* choice = json.node("choice");
  if (choice != nullptr && JSON_NODE_HOLDS_OBJECT(choice)) {
    return drawn_ellipse(RequestJson(json_node_get_object(choice)));
  }
  if (choice != nullptr && JSON_NODE_HOLDS_VALUE(choice) &&
      json_node_get_value_type(choice) == G_TYPE_INT64) {
    return shown_ellipse(frame, json.number("choice"));
  }
  if (json.text("choice") != "none") {
    throw std::invalid_argument("choice: expected a number, an ellipse or \"none\"");
  }
  return std::nullopt;
}

}  // namespace

void add_labels(HttpServer& server, Session& session, const Options& options) {
  if (options.labels.empty()) {
    server.route("POST", "/api/snapshot", [](const Request&) {
      return error_reply(409, "no folder for labels: start ellipse-live with --labels FOLDER");
    });
    return;
  }
  const auto labels = std::make_shared<LabelStore>(options.labels);
  server.route("POST", "/api/snapshot", [&session, labels](const Request& request) {
    const FramePtr frame = session.store().newest();
    if (!frame) return error_reply(409, "no frame yet");
    const RequestJson json(request.body);
    if (json.has("pts_ns") && json.time("pts_ns") != frame->pts) {
      return error_reply(409, "the shown frame has changed: pause the source first");
    }
    const std::string image = labels->add(*frame, chosen(json, *frame));
    return Reply{.body =
                     JsonWriter().begin_object().member("image", image).end_object().text() + "\n"};
  });
}

}  // namespace live
