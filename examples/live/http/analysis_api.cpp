// SPDX-License-Identifier: MIT
#include "examples/live/http/analysis_api.hpp"

#include <json-glib/json-glib.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "examples/live/pipeline/analysis.hpp"
#include "examples/live/pipeline/analyst.hpp"
#include "examples/live/pipeline/replay.hpp"
#include "examples/live/request_json.hpp"

namespace live {
namespace {

std::optional<ellipse::Stage> stage_in(const RequestJson& json) {
  if (!json.has("stage")) return std::nullopt;
  const std::string nick = json.text("stage");
  const auto nicks = ellipse::stage_nicks();
  const auto found = std::find(nicks.begin(), nicks.end(), nick);
  if (found != nicks.end()) return static_cast<ellipse::Stage>(found - nicks.begin());
  throw std::invalid_argument("stage: unknown stage \"" + nick + "\"");
}

std::string text_of(JsonNode* node) {
  if (node == nullptr) return "";
  const Ref<gchar> text(json_to_string(node, FALSE));
  return text.get();
}

// Replies when the work is complete.
void reply_with(Analyst& analyst, const Request& request, Analyst::Work work) {
  const auto reply = std::make_shared<LaterReply>(request.message);
  const bool is_taken = analyst.ask(std::move(work), [reply](const auto& text, const auto& error) {
    reply->send(error.empty() ? Reply{.body = text} : error_reply(500, error));
  });
  if (!is_taken) reply->send(error_reply(503, "too many analyses are waiting"));
}

// The stored frame that "frame" names, or the shown frame.
FramePtr frame_in(const RequestJson& json, Session& session) {
  if (!json.has("frame")) return session.store().newest();
  session.history().touch();
  return session.history().find(json.whole("frame"));
}

void add_analyze(HttpServer& server, Session& session, const std::shared_ptr<Analyst>& analyst) {
  server.route_open("POST", "/api/analyze", [&session, analyst](const Request& request) {
    const RequestJson json(request.body);
    const AnalysisRequest wanted{
        .frame = frame_in(json, session),
        .settings = session.properties().settings_with(text_of(json.node("properties"))),
        .stage = stage_in(json)};
    if (!wanted.frame) {
      return answer(request.message,
                    json.has("frame") ? error_reply(410, "the frame is no longer stored")
                                      : error_reply(409, "no frame yet"));
    }
    reply_with(*analyst, request, [wanted](const auto&) { return analysis_json(wanted); });
  });
}

/* Stored frames */

guint64 number_in(JsonNode* node) {
  if (JSON_NODE_HOLDS_VALUE(node) && json_node_get_value_type(node) == G_TYPE_INT64) {
    return static_cast<guint64>(json_node_get_int(node));
  }
  throw std::invalid_argument("frames: expected an array of whole numbers");
}

// The stored frames that the array "frames" names, or all. Empty if one of them is not stored.
std::vector<FramePtr> frames_in(const RequestJson& json, const FrameHistory& history) {
  if (!json.has("frames")) return history.frames();
  JsonNode* node = json.node("frames");
  JsonArray* numbers = JSON_NODE_HOLDS_ARRAY(node) ? json_node_get_array(node) : nullptr;
  if (numbers == nullptr || json_array_get_length(numbers) > history.limits().frames) {
    throw std::invalid_argument("frames: expected an array of at most " +
                                std::to_string(history.limits().frames) + " numbers");
  }
  std::vector<FramePtr> frames;
  for (guint i = 0; i < json_array_get_length(numbers); ++i) {
    FramePtr frame = history.find(number_in(json_array_get_element(numbers, i)));
    if (!frame) return {};
    frames.push_back(std::move(frame));
  }
  return frames;
}

void add_replay(HttpServer& server, Session& session, const std::shared_ptr<Analyst>& analyst) {
  server.route_open("POST", "/api/history/replay", [&session, analyst](const Request& request) {
    session.history().touch();
    const RequestJson json(request.body);
    const std::string changes = text_of(json.node("properties"));
    const ReplayRequest wanted{.frames = frames_in(json, session.history()),
                               .settings = session.properties().settings_with(changes),
                               .region = session.properties().region_with(changes),
                               .is_single = json.has("frames")};
    if (wanted.frames.empty()) {
      return answer(request.message, error_reply(410, "the frames are no longer stored"));
    }
    reply_with(*analyst, request, [wanted](const auto& stop) { return replay_json(wanted, stop); });
  });
}

}  // namespace

void add_analysis(HttpServer& server, Session& session) {
  const auto analyst = std::make_shared<Analyst>();
  add_analyze(server, session, analyst);
  add_replay(server, session, analyst);
}

}  // namespace live
