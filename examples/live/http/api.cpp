// SPDX-License-Identifier: MIT
#include "examples/live/http/api.hpp"

#include <json-glib/json-glib.h>

#include <memory>

#include "examples/live/http/analysis_api.hpp"
#include "examples/live/http/history_api.hpp"
#include "examples/live/http/label_api.hpp"
#include "examples/live/http/metrics.hpp"
#include "examples/live/http/page_files.hpp"
#include "examples/live/json_writer.hpp"
#include "examples/live/pipeline/launch_line.hpp"
#include "examples/live/pipeline/presets.hpp"
#include "examples/live/request_json.hpp"
#include "examples/live/structure_json.hpp"

namespace live {
namespace {

constexpr std::size_t kMaxStreams = 120;  // reserves 40 of the 160 connections for requests
constexpr char kTooMany[] = "too many clients";

void write_time(JsonWriter& json, const char* name, GstClockTime time) {
  json.key(name);
  GST_CLOCK_TIME_IS_VALID(time) ? json.value(time) : json.null();
}

Reply done() {
  return {.body = "{}\n"};
}

void add_page(HttpServer& server, const Options& options) {
  const PageFiles page(options.page);
  server.route("GET", "/", [page](const Request&) { return page.get("index.html"); });
  server.route("GET", "/*", [page](const Request& request) { return page.get(request.rest); });
}

// Reserves connections for requests.
bool has_room(Session& session) {
  return session.video().viewers() + session.lines().listeners() < kMaxStreams;
}

void add_feeds(HttpServer& server, Session& session) {
  const auto websocket = [&](const char* path, auto add) {
    server.websocket(path, [&session, add](std::unique_ptr<WebSocket> socket) {
      has_room(session) ? add(std::move(socket)) : socket->close(kTooMany);
    });
  };
  const auto stream = [&](const char* path, auto add) {
    server.route_open("GET", path, [&session, add](const Request& request) {
      has_room(session) ? add(request.message)
                        : answer(request.message, error_reply(503, kTooMany));
    });
  };
  websocket("/ws/video", [&](auto socket) { session.video().add(std::move(socket)); });
  websocket("/ws/meta", [&](auto socket) { session.lines().add(std::move(socket)); });
  stream("/video.mjpeg", [&](auto* message) { session.video().add_stream(message); });
  stream("/api/events", [&](auto* message) { session.lines().add_events(message); });
}

/* State */

std::string target_json(GstElement* tracker) {
  GstStructure* fields = nullptr;
  g_object_get(tracker, "target", &fields, nullptr);
  if (fields == nullptr) return "null\n";
  const Ref<GstStructure> target(fields);
  JsonWriter json;
  json.begin_object();
  write_fields(json, target.get());
  return json.end_object().text() + "\n";
}

std::string stats_json(Session& session, const HttpServer& server) {
  GstStructure* fields = nullptr;
  g_object_get(session.pipeline().tracker(), "stats", &fields, nullptr);
  const Ref<GstStructure> stats(fields);
  JsonWriter json;
  json.begin_object().key("tracker").begin_object();
  write_fields(json, stats.get());
  json.end_object()
      .member("frames", session.pipeline().frames())
      .member("reconnections", session.pipeline().reconnections())
      .member("viewers", session.video().viewers())
      .member("listeners", session.lines().listeners())
      .member("connections", server.connections())
      .member("encoded", session.video().encoded())
      .member("sent", session.video().sent())
      .member("sent_bytes", session.video().sent_bytes())
      .member("lines_lost", session.lines().lost());
  write_time(json, "paint_delay_median_ns", session.video().paint_delay(0.5));
  write_time(json, "paint_delay_p99_ns", session.video().paint_delay(0.99));
  return json.end_object().text() + "\n";
}

void add_state(HttpServer& server, Session& session) {
  server.route("GET", "/api/target", [&](const Request&) {
    return Reply{.body = target_json(session.pipeline().tracker())};
  });
  server.route("GET", "/api/stats", [&](const Request&) {
    return Reply{.body = stats_json(session, server)};
  });
  server.route("GET", "/metrics", [&](const Request&) {
    return Reply{.type = "text/plain; version=0.0.4; charset=utf-8",
                 .body = metrics_text(session, server)};
  });
}

/* Settings */

void add_settings(HttpServer& server, Session& session) {
  GstElement* tracker = session.pipeline().tracker();
  server.route("GET", "/api/properties", [&](const Request&) {
    return Reply{.body = session.properties().to_json()};
  });
  server.route("PUT", "/api/properties", [&](const Request& request) {
    if (session.properties().set(request.body)) session.review();
    return done();
  });
  server.route("GET", "/api/presets", [tracker](const Request&) {
    return Reply{.body = presets_json(tracker)};
  });
  server.route("PUT", "/api/presets/*", [tracker](const Request& request) {
    save_preset(tracker, request.rest);
    return done();
  });
  server.route("POST", "/api/presets/*/load", [tracker, &session](const Request& request) {
    load_preset(tracker, request.rest);
    session.review();
    return done();
  });
  server.route("DELETE", "/api/presets/*", [tracker](const Request& request) {
    delete_preset(tracker, request.rest);
    return done();
  });
  server.route("GET", "/api/launch-line", [&](const Request&) {
    return Reply{.type = "text/plain; charset=utf-8",
                 .body = launch_line(session.pipeline().source(), session.properties())};
  });
}

/* Source and playback */

std::string source_json(Session& session, const Options& options) {
  const LivePipeline& pipeline = session.pipeline();
  const FramePtr frame = session.store().newest();
  JsonWriter json;
  json.begin_object()
      .member("spec", pipeline.source().text)
      .member("kind", nick_of(pipeline.source().kind))
      .member("live", pipeline.source().is_live)
      .member("seekable", pipeline.is_seekable())
      .member("playing", session.is_playing())
      .member("state", session.store().is_held() ? "held" : nick_of(pipeline.state()))
      .member("error", pipeline.trouble())
      .member("can_change", options.allows_source_change)
      .member("can_label", !options.labels.empty())
      .member("width", frame ? frame->width : 0)
      .member("height", frame ? frame->height : 0)
      .member("fps", frame ? frame->rate : 0.0);
  write_time(json, "pts_ns", frame ? frame->pts : GST_CLOCK_TIME_NONE);
  write_time(json, "position_ns", pipeline.position());
  write_time(json, "duration_ns", pipeline.duration());
  return json.end_object().text() + "\n";
}

// A number, or a string such as "30000/1001".
std::string rate_in(const RequestJson& json) {
  JsonNode* fps = json.node("fps");
  if (fps == nullptr) return "";
  const bool is_text = JSON_NODE_HOLDS_VALUE(fps) && json_node_get_value_type(fps) == G_TYPE_STRING;
  return is_text ? json.text("fps") : JsonWriter().value(json.number("fps")).text();
}

void add_playback(HttpServer& server, Session& session, const Options& options) {
  server.route("GET", "/api/source", [&session, options](const Request&) {
    return Reply{.body = source_json(session, options)};
  });
  server.route("POST", "/api/play", [&](const Request&) { return session.play(), done(); });
  server.route("POST", "/api/pause", [&](const Request&) { return session.pause(), done(); });
  server.route("POST", "/api/step", [&](const Request&) {
    if (session.is_playing()) return error_reply(409, "pause the source first");
    session.step();
    return done();
  });
  server.route("POST", "/api/seek", [&](const Request& request) {
    const RequestJson json(request.body);
    return session.seek(json.time("position_ns")) ? done()
                                                  : error_reply(409, "this source cannot seek");
  });
  server.route("PUT", "/api/source", [&session, options](const Request& request) {
    if (!options.allows_source_change) {
      return error_reply(403, "changing the source requires --allow-source-change");
    }
    const RequestJson json(request.body);
    session.open(json.text("spec"), rate_in(json));
    return done();
  });
}

}  // namespace

void add_api(HttpServer& server, Session& session, const Options& options) {
  add_feeds(server, session);
  add_state(server, session);
  add_settings(server, session);
  add_playback(server, session, options);
  add_analysis(server, session);
  add_history(server, session);
  add_labels(server, session, options);
  add_page(server, options);
}

}  // namespace live
