// SPDX-License-Identifier: MIT
#include "examples/live/http/history_api.hpp"

#include <json-glib/json-glib.h>

#include <stdexcept>
#include <string>

#include "examples/live/json_writer.hpp"
#include "examples/live/request_json.hpp"
#include "gst/ellipse/gstellipsemeta.h"

namespace live {
namespace {

// Whether a target is visible in the frame; a predicted one is not.
bool has_target(const Frame& frame) {
  const GstEllipseMeta* target = gst_buffer_get_ellipse_meta(
      gst_sample_get_buffer(frame.sample.get()), GST_ELLIPSE_ROLE_TARGET);
  return target != nullptr && target->state != GST_ELLIPSE_STATE_PREDICTED;
}

// Writes times as text, because doubles cannot represent nanoseconds since 1970 exactly.
std::string history_json(const FrameHistory& history) {
  JsonWriter json;
  json.begin_object()
      .member("storing", history.is_storing())
      .member("full", history.is_full())
      .member("max_frames", history.limits().frames)
      .key("frames")
      .begin_array();
  for (const FramePtr& frame : history.frames()) {
    json.begin_object()
        .member("frame", frame->index)
        .member("pts_ns", std::to_string(frame->pts))
        .member("has_target", has_target(*frame))
        .end_object();
  }
  return json.end_array().end_object().text() + "\n";
}

bool is_storing_wanted(const RequestJson& json) {
  JsonNode* node = json.node("storing");
  if (node == nullptr || !JSON_NODE_HOLDS_VALUE(node) ||
      json_node_get_value_type(node) != G_TYPE_BOOLEAN) {
    throw std::invalid_argument("storing: expected true or false");
  }
  return json_node_get_boolean(node) != FALSE;
}

}  // namespace

void add_history(HttpServer& server, Session& session) {
  server.route("GET", "/api/history", [&session](const Request&) {
    session.history().touch();
    return Reply{.body = history_json(session.history())};
  });
  server.route("PUT", "/api/history", [&session](const Request& request) {
    is_storing_wanted(RequestJson(request.body)) ? session.history().begin()
                                                 : session.history().end();
    return Reply{.body = history_json(session.history())};
  });
  server.route("DELETE", "/api/history", [&session](const Request&) {
    session.history().clear();
    return Reply{.body = "{}\n"};
  });
  server.route("POST", "/api/history/show", [&session](const Request& request) {
    session.history().touch();
    const FramePtr frame = session.history().find(RequestJson(request.body).whole("frame"));
    if (!frame) return error_reply(410, "the frame is no longer stored");
    session.show(frame);
    return Reply{.body = "{}\n"};
  });
}

}  // namespace live
