// SPDX-License-Identifier: MIT
//
// Which metadata survives. The rows of the table in docs/metadata.md are the tests: each pipeline
// runs as written there, and the metadata on its buffers is compared with their pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/tracking/tracker.hpp"
#include "gst/ellipse/gstellipsesearchmeta.h"
#include "gst/meta_ellipse.hpp"
#include "tests/gst/support.hpp"

namespace {

using support::run_pipeline;
using support::TemporaryFolder;

constexpr char kTrackedSource[] =
    "ellipsetestsrc scene=oblique num-buffers=15 ! "
    "video/x-raw,format=I420,width=640,height=360,framerate=30/1 ! ellipsetrack ! ";

struct Row {
  std::string pipeline;  // elements behind ellipsetrack
  std::string reader;    // a second pipeline, if the first one ends in a file
  std::string ellipses;  // expected result for the ellipses
  std::string region;    // expected result for the region of interest
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
  return out << row.pipeline << (row.reader.empty() ? "" : " then ") << row.reader;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

// A row of the table names several pipelines, `a`, `b`, or two that form one case: `a` then `b`.
void append_rows(const std::string& line, std::vector<Row>& rows) {
  const std::vector<std::string> cells = split(line, '|');  // the first cell precedes the table
  const std::vector<std::string> pieces = split(cells.at(1), '`');
  for (std::size_t i = 1; i < pieces.size(); i += 2) {
    if (trimmed(pieces[i - 1]) == "then") {
      rows.back().reader = pieces[i];
    } else {
      rows.push_back({pieces[i], "", trimmed(cells.at(2)), trimmed(cells.at(3))});
    }
  }
}

std::vector<Row> rows_of_the_document() {
  std::vector<Row> rows;
  std::ifstream in(ELLIPSE_METADATA_DOC);
  std::string line;
  while (std::getline(in, line) && !line.starts_with("| behind ellipsetrack |")) continue;
  std::getline(in, line);  // the separator below the header
  while (std::getline(in, line) && line.starts_with("|")) append_rows(line, rows);
  return rows;
}

// Errors in between give no verdict, so that noise decides none.
constexpr double kRightPx = 0.5;
constexpr double kWrongPx = 5.0;

std::string verdict_on(double error_px, double tolerance_px = kRightPx) {
  if (error_px <= tolerance_px) return "kept";
  return error_px >= kWrongPx ? "wrong" : "off by " + std::to_string(error_px) + " px";
}

double difference_px(const GstEllipseMeta& meta, const ellipse::Ellipse& detected) {
  const ellipse::Ellipse carried = ellipse_of(meta);
  double farthest = 0.0;
  for (int i = 0; i < 32; ++i) {
    const double distance = ellipse::sampson_distance(detected, carried.point_at(0.2 * i));
    farthest = std::max(farthest, std::abs(distance));
  }
  return farthest;
}

// Checks the metadata of each buffer.
class Witness {
 public:
  void watch(GstElement* pipeline) {
    const support::Owned<GstElement> sink(gst_bin_get_by_name(GST_BIN(pipeline), "out"));
    GstPad* pad = gst_element_get_static_pad(sink.get(), "sink");
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, on_buffer, this, nullptr);
    gst_object_unref(pad);
  }
  [[nodiscard]] std::string ellipses() const { return joined(ellipses_); }
  [[nodiscard]] std::string region() const { return joined(regions_); }
  [[nodiscard]] int frames() const { return frames_; }

 private:
  static GstPadProbeReturn on_buffer(GstPad* pad, GstPadProbeInfo* info, gpointer data) {
    GstCaps* caps = gst_pad_get_current_caps(pad);
    GstVideoInfo video;
    gst_video_info_from_caps(&video, caps);
    gst_caps_unref(caps);
    static_cast<Witness*>(data)->judge(GST_PAD_PROBE_INFO_BUFFER(info), video);
    return GST_PAD_PROBE_OK;
  }

  void judge(GstBuffer* buffer, const GstVideoInfo& info) {
    const support::GrayPicture picture = support::picture_of(buffer, info);
    const auto detected = tracker_.process(picture.view(), 0);
    ellipses_.insert(verdict_on_ellipses(buffer, detected));
    regions_.insert(verdict_on_region(buffer, detected));
    ++frames_;
  }

  static std::string verdict_on_ellipses(GstBuffer* buffer,
                                         const std::optional<ellipse::Target>& detected) {
    const auto* truth = gst_buffer_get_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TRUTH);
    const auto* target = gst_buffer_get_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
    const bool has_search = gst_buffer_get_ellipse_search_meta(buffer) != nullptr;
    if (truth == nullptr && target == nullptr && !has_search) return "lost";
    if (truth == nullptr || target == nullptr || !has_search) return "lost in part";
    if (!detected) return "nothing to compare with";
    const std::string verdict = verdict_on(difference_px(*truth, detected->ellipse));
    return verdict == verdict_on(difference_px(*target, detected->ellipse)) ? verdict : "mixed";
  }

  static std::string verdict_on_region(GstBuffer* buffer,
                                       const std::optional<ellipse::Target>& detected) {
    auto* meta = reinterpret_cast<GstVideoRegionOfInterestMeta*>(
        gst_buffer_get_meta(buffer, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE));
    if (meta == nullptr) return "lost";
    if (!detected) return "nothing to compare with";
    const Eigen::Vector2d half = ellipse::half_extent(detected->ellipse);
    const Eigen::Vector2d first = detected->ellipse.center() - half;
    const Eigen::Vector2d last = detected->ellipse.center() + half;
    const double error_px = std::max({std::abs(meta->x - first.x()),
                                      std::abs(meta->y - first.y()),
                                      std::abs(meta->x + meta->w - 1.0 - last.x()),
                                      std::abs(meta->y + meta->h - 1.0 - last.y())});
    // Regions are in whole pixels, and a scaler rounds them again.
    const std::string verdict = verdict_on(error_px, 3.0);
    const bool has_details =
        gst_video_region_of_interest_meta_get_param(meta, "ellipse") != nullptr;
    return verdict == "kept" && !has_details ? "box" : verdict;
  }

  static std::string joined(const std::set<std::string>& verdicts) {
    std::string text;
    for (const std::string& verdict : verdicts) text += (text.empty() ? "" : " and ") + verdict;
    return text;
  }

  ellipse::Tracker tracker_{{.tracking = ellipse::TrackingMode::kNone}};
  std::set<std::string> ellipses_;
  std::set<std::string> regions_;
  int frames_ = 0;
};

std::string in_folder(std::string pipeline, const TemporaryFolder& folder) {
  const std::string key = "location=";
  const auto at = pipeline.find(key);
  return at == std::string::npos ? pipeline : pipeline.insert(at + key.size(), folder.file(""));
}

class Survival : public testing::TestWithParam<Row> {};

TEST_P(Survival, MatchesTheDocument) {
  const Row& row = GetParam();
  const TemporaryFolder folder;
  Witness witness;
  std::string failure;
  std::string watched = kTrackedSource + row.pipeline;
  if (!row.reader.empty()) {
    failure = run_pipeline(in_folder(watched, folder));
    watched = in_folder(row.reader, folder);
  }
  if (failure.empty()) {
    failure = run_pipeline(watched + " ! fakesink name=out",
                           [&](GstElement* pipeline) { witness.watch(pipeline); });
  }
  if (failure.starts_with(support::Pipeline::kNotInstalled)) GTEST_SKIP() << failure;
  ASSERT_EQ(failure, "");
  EXPECT_GE(witness.frames(), 7);
  EXPECT_EQ(witness.ellipses(), row.ellipses);
  EXPECT_EQ(witness.region(), row.region);
}

std::string name_of(const testing::TestParamInfo<Row>& info) {
  std::ostringstream text;
  text << info.param;
  std::string name = text.str();
  const auto is_sign = [](unsigned char c) { return std::isalnum(c) == 0; };
  std::replace_if(name.begin(), name.end(), is_sign, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Document, Survival, testing::ValuesIn(rows_of_the_document()), name_of);

TEST(SurvivalTable, ListsTheUsualDownstreamElements) {
  std::string all;
  const std::set<std::string> words{"kept", "box", "wrong", "lost"};
  for (const Row& row : rows_of_the_document()) {
    all += row.pipeline + " " + row.reader + "\n";
    EXPECT_TRUE(words.contains(row.ellipses)) << row;
    EXPECT_TRUE(words.contains(row.region)) << row;
  }
  for (const char* element : {"queue",        "tee",         "videorate",
                              "videoconvert", "videoscale",  "x264enc",
                              "avdec_h264",   "openh264enc", "jpegenc",
                              "jpegdec",      "textoverlay", "videocrop",
                              "videoflip",    "videobox",    "rtpvrawpay",
                              "rtph264pay",   "mpegtsmux",   "tsdemux",
                              "matroskamux",  "filesink",    "add-borders=false"}) {
    EXPECT_NE(all.find(element), std::string::npos) << element;
  }
}

}  // namespace
