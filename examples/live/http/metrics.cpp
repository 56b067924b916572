// SPDX-License-Identifier: MIT
#include "examples/live/http/metrics.hpp"

#include <array>
#include <string_view>

#include "examples/live/json_writer.hpp"

namespace live {
namespace {

class Metrics {
 public:
  void add(std::string_view name, std::string_view type, std::string_view help, double value) {
    describe(name, type, help);
    sample(name, "", value);
  }
  void describe(std::string_view name, std::string_view type, std::string_view help) {
    text_ += "# HELP ellipse_" + std::string(name) + " " + std::string(help) + "\n";
    text_ += "# TYPE ellipse_" + std::string(name) + " " + std::string(type) + "\n";
  }
  void sample(std::string_view name, std::string_view labels, double value) {
    text_ += "ellipse_" + std::string(name) + std::string(labels) + " " + json_number(value) + "\n";
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

double count(const GstStructure* stats, const char* field) {
  guint64 value = 0;
  gst_structure_get_uint64(stats, field, &value);
  return static_cast<double>(value);
}

void add_tracker(Metrics& metrics, GstElement* tracker) {
  GstStructure* fields = nullptr;
  g_object_get(tracker, "stats", &fields, nullptr);
  const Ref<GstStructure> stats(fields);
  metrics.describe("frames", "gauge", "Frames since the source was started, by outcome.");
  for (const char* fate : {"analysed", "skipped", "detected", "tracked", "predicted"}) {
    metrics.sample("frames", std::string("{fate=\"") + fate + "\"}", count(stats.get(), fate));
  }
  metrics.add("losses", "gauge", "Number of times a target was lost.", count(stats.get(), "lost"));
  metrics.describe("processing_seconds", "gauge", "Processing time of the last 1024 analyses.");
  const auto time = [&](const char* field) { return 1e-9 * count(stats.get(), field); };
  metrics.sample("processing_seconds", "{quantile=\"0.5\"}", time("processing-time-median"));
  metrics.sample("processing_seconds", "{quantile=\"0.99\"}", time("processing-time-p99"));
  metrics.sample("processing_seconds", "{quantile=\"1\"}", time("processing-time-max"));
  GstStructure* target = nullptr;
  g_object_get(tracker, "target", &target, nullptr);
  metrics.add("target_present", "gauge", "1 while there is a target.", target != nullptr ? 1 : 0);
  if (target != nullptr) gst_structure_free(target);
}

}  // namespace

std::string metrics_text(Session& session, const HttpServer& server) {
  Metrics metrics;
  const auto counter = [&](std::string_view name, std::string_view help, guint64 value) {
    metrics.add(name, "counter", help, static_cast<double>(value));
  };
  const auto gauge = [&](std::string_view name, std::string_view help, std::size_t value) {
    metrics.add(name, "gauge", help, static_cast<double>(value));
  };
  const LivePipeline& pipeline = session.pipeline();
  counter("frames_total", "Frames that the pipeline delivered.", pipeline.frames());
  add_tracker(metrics, pipeline.tracker());
  counter("reconnections_total", "Attempts to reconnect the source.", pipeline.reconnections());
  gauge("source_up", "1 while the source delivers frames.", pipeline.trouble().empty() ? 1 : 0);
  gauge("viewers", "Clients of the video.", session.video().viewers());
  gauge("listeners", "Clients of the JSON lines.", session.lines().listeners());
  gauge("connections", "Open HTTP connections.", server.connections());
  counter("jpegs_total", "Frames encoded as JPEG.", session.video().encoded());
  counter("pictures_sent_total", "Pictures sent to viewers.", session.video().sent());
  counter(
      "picture_bytes_total", "Bytes of pictures sent to viewers.", session.video().sent_bytes());
  counter("lines_lost_total", "Lines dropped for slow listeners.", session.lines().lost());
  counter("requests_total", "HTTP requests.", server.counters().requests);
  counter("requests_refused_total", "Rejected HTTP requests.", server.counters().refused);
  return metrics.text();
}

}  // namespace live
