// SPDX-License-Identifier: MIT
//
// Stored frames and their analysis with other settings.
#include <gst/gst.h>
#include <gst/video/video.h>
#include <gtest/gtest.h>

#include <string>

#include "examples/live/pipeline/frame_history.hpp"
#include "tests/gst/support.hpp"
#include "tests/live/live_clients.hpp"
#include "tests/live/live_program.hpp"
#include "tests/live/live_sources.hpp"

namespace {

using live::FrameHistory;
using live::FramePtr;
using live::Ref;
using support::Answer;
using support::Client;
using support::LiveProgram;
using support::TemporaryFolder;
using support::wait_until;

constexpr int kSize = 64;  // width and height [px]; a frame has kSize^2 bytes

FramePtr gray_frame(guint64 index) {
  const Ref<GstCaps> caps(
      gst_caps_from_string("video/x-raw,format=GRAY8,width=64,height=64,framerate=30/1"));
  Ref<GstBuffer> input(gst_buffer_new_allocate(nullptr, kSize * kSize, nullptr));
  gst_buffer_memset(input.get(), 0, static_cast<guint8>(index), kSize * kSize);
  GST_BUFFER_PTS(input.get()) = index * GST_MSECOND;
  const Ref<GstSample> sample(gst_sample_new(input.get(), caps.get(), nullptr, nullptr));
  return live::make_frame(sample.get(), std::move(input), index, 0);
}

guint8 first_byte(GstBuffer* buffer) {
  guint8 byte = 0;
  gst_buffer_extract(buffer, 0, &byte, 1);
  return byte;
}

TEST(FrameHistory, KeepsTheLastFramesUpToItsLimits) {
  FrameHistory by_number({.frames = 3});
  FrameHistory by_bytes({.frames = 100, .bytes = 2 * kSize * kSize});
  for (FrameHistory* history : {&by_number, &by_bytes}) {
    history->put(*gray_frame(7));
    EXPECT_TRUE(history->frames().empty()) << "stores without being asked to";
    history->begin();
    for (guint64 i = 0; i < 5; ++i) history->put(*gray_frame(i));
    history->end();
    history->put(*gray_frame(5));
    EXPECT_TRUE(history->is_full());
    EXPECT_EQ(history->frames().back()->index, 4U);
    EXPECT_EQ(history->find(0), nullptr);
  }
  EXPECT_EQ(by_number.frames().size(), 3U);
  EXPECT_EQ(by_bytes.frames().size(), 2U);
}

TEST(FrameHistory, CopiesThePixels) {
  FrameHistory history;
  history.begin();
  const FramePtr frame = gray_frame(9);
  history.put(*frame);
  const FramePtr stored = history.find(9);
  ASSERT_NE(stored, nullptr);
  EXPECT_NE(gst_buffer_peek_memory(stored->input.get(), 0),
            gst_buffer_peek_memory(frame->input.get(), 0));
  EXPECT_EQ(first_byte(stored->input.get()), 9);
  EXPECT_EQ(first_byte(gst_sample_get_buffer(stored->sample.get())), 9);
  EXPECT_EQ(stored->pts, frame->pts);
  EXPECT_EQ(stored->line, frame->line);
  EXPECT_NE(stored->number, frame->number);
}

JsonArray* frames_of(const Answer& answer) {
  JsonObject* object = answer.object();
  const bool has_frames = object != nullptr && json_object_has_member(object, "frames");
  return has_frames ? json_object_get_array_member(object, "frames") : nullptr;
}

guint count_of(const Answer& answer) {
  JsonArray* frames = frames_of(answer);
  return frames != nullptr ? json_array_get_length(frames) : 0;
}

gint64 number_of(const Answer& answer, guint i) {
  return json_object_get_int_member(json_array_get_object_element(frames_of(answer), i), "frame");
}

guint targets_in(const Answer& answer) {
  guint count = 0;
  for (guint i = 0; i < count_of(answer); ++i) {
    JsonObject* frame = json_array_get_object_element(frames_of(answer), i);
    if (!json_object_get_null_member(frame, "target")) ++count;
  }
  return count;
}

// Stores at least this number of frames. @return Their list.
Answer stored_frames(const Client& client, guint min_count) {
  EXPECT_EQ(client.put("api/history", R"({"storing":true})").status, 200U);
  EXPECT_TRUE(wait_until([&] { return count_of(client.get("api/history")) >= min_count; }));
  return client.put("api/history", R"({"storing":false})");
}

std::string body_of(gint64 frame, const std::string& properties = "") {
  return R"({"frames":[)" + std::to_string(frame) + "]" +
         (properties.empty() ? "" : R"(,"properties":)" + properties) + "}";
}

TEST(LiveHistory, ReplaysFramesWithOtherSettings) {
  const LiveProgram program({"--source", "test:orbit"});
  const Client client(program.url());
  const Answer stored = stored_frames(client, 20);
  const guint count = count_of(stored);
  EXPECT_EQ(targets_in(client.post("api/history/replay", "{}")), count);
  EXPECT_EQ(targets_in(client.post("api/history/replay", R"({"properties":{"min-axis":690}})")),
            0U);
  EXPECT_EQ(count_of(client.get("api/history")), count);
  EXPECT_EQ(support::value_of(client, "min-axis"), 5.0);  // the pipeline's own value
}

TEST(LiveHistory, ReplaysSingleFramesInTheirRegion) {
  const LiveProgram program({"--source", "test:orbit"});
  const Client client(program.url());
  const gint64 frame = number_of(stored_frames(client, 5), 2);
  const Answer whole = client.post("api/history/replay", body_of(frame));
  ASSERT_EQ(count_of(whole), 1U);
  EXPECT_EQ(targets_in(whole), 1U);
  EXPECT_NE(whole.body.find(R"("found":[{)"), std::string::npos);
  const Answer corner = client.post(
      "api/history/replay", body_of(frame, R"({"roi":[0,0,40,40],"roi-source":"property"})"));
  ASSERT_EQ(count_of(corner), 1U);
  EXPECT_EQ(targets_in(corner), 0U);
}

class StoredFrame : public testing::TestWithParam<const char*> {
 protected:
  std::string source() {
    return GetParam() == std::string("file") ? support::make_video(folder_, 300) : "test:orbit";
  }

  TemporaryFolder folder_;
};

TEST_P(StoredFrame, CanBeShownAnalysedAndLeft) {
  const LiveProgram program({"--source", source()});
  const Client client(program.url());
  const gint64 frame = number_of(stored_frames(client, 10), 3);
  const std::string body = R"({"frame":)" + std::to_string(frame) + "}";
  ASSERT_EQ(client.post("api/history/show", body).status, 200U);
  support::SocketClient lines(program.url(), "ws/meta");
  EXPECT_EQ(support::Line(lines.next()).number("frame"), frame);
  EXPECT_EQ(support::text_in(client, "state"), "held");
  EXPECT_EQ(client.post("api/analyze", body).status, 200U);
  ASSERT_EQ(client.put("api/properties", R"({"min-axis":690})").status, 200U);
  const support::Line again(lines.next());
  EXPECT_EQ(again.number("frame"), frame);
  EXPECT_EQ(again.ellipse("target"), nullptr);
  ASSERT_EQ(client.post("api/step").status, 200U);
  EXPECT_GT(support::Line(lines.next()).number("frame"), frame);
  ASSERT_EQ(client.post("api/play").status, 200U);
  EXPECT_TRUE(wait_until([&] { return support::text_in(client, "state") == "playing"; }));
}

INSTANTIATE_TEST_SUITE_P(LiveHistory,
                         StoredFrame,
                         testing::Values("file", "live"),
                         [](const auto& info) { return std::string(info.param); });

TEST(LiveHistory, ReportsDiscardedFrames) {
  const LiveProgram program({"--source", "test:orbit", "--allow-source-change"});
  const Client client(program.url());
  const gint64 frame = number_of(stored_frames(client, 5), 0);
  ASSERT_EQ(client.put("api/source", R"({"spec":"test:disc"})").status, 200U);
  const std::string body = R"({"frame":)" + std::to_string(frame) + "}";
  EXPECT_EQ(client.post("api/history/show", body).status, 410U);
  EXPECT_EQ(client.post("api/analyze", body).status, 410U);
  EXPECT_EQ(client.post("api/history/replay", body_of(frame)).status, 410U);
  EXPECT_EQ(client.post("api/history/replay", "{}").status, 410U);
}

TEST(LiveHistory, RejectsInvalidRequests) {
  const LiveProgram program({"--source", "test:orbit"});
  const Client client(program.url());
  (void)stored_frames(client, 1);
  for (const char* body : {R"({"storing":1})", "{}", "7"}) {
    EXPECT_EQ(client.put("api/history", body).status, 400U) << body;
  }
  for (const char* body : {"{}", R"({"frame":-1})", R"({"frame":"1"})", R"({"frame":1e300})"}) {
    EXPECT_EQ(client.post("api/history/show", body).status, 400U) << body;
  }
  for (const char* body : {R"({"frames":7})",
                           R"({"frames":["1"]})",
                           R"({"frames":[0.5]})",
                           R"({"properties":{"min-axis":0}})",
                           R"({"properties":7})"}) {
    EXPECT_EQ(client.post("api/history/replay", body).status, 400U) << body;
  }
  EXPECT_EQ(client.ask("DELETE", "api/history").status, 200U);
  EXPECT_EQ(count_of(client.get("api/history")), 0U);
}

}  // namespace
