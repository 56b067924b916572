// SPDX-License-Identifier: MIT
//
// JSON lines through GStreamer's own sinks, read at the receivers.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/gst/loopback.hpp"
#include "tests/gst/support.hpp"

namespace {

using support::Broker;
using support::contents_of;
using support::count_lines;
using support::object_of;
using support::Pipeline;
using support::program;
using support::run_pipeline;
using support::Server;
using support::Socket;
using support::TemporaryFolder;

constexpr std::size_t kLineCount = 30;
const std::string kLines =
    "ellipsetestsrc num-buffers=" + std::to_string(kLineCount) + " ! ellipsetrack ! ellipsejson ! ";

// Checks that each line is a JSON object, and that the frames are consecutive from the first.
void expect_frames(const std::string& text, std::size_t first, std::size_t count) {
  ASSERT_TRUE(text.ends_with('\n'));
  const auto lines = support::parse_ndjson(std::istringstream(text));
  EXPECT_EQ(lines.size(), count);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    JsonObject* line = object_of(lines[i]);
    ASSERT_NE(line, nullptr) << "line " << i << " is no JSON";
    ASSERT_EQ(json_object_get_int_member(line, "frame"), static_cast<gint64>(first + i));
  }
}

TEST(NdjsonSinks, FileSink) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_pipeline(kLines + "filesink location=" + folder.file("lines")), "");
  expect_frames(contents_of(folder.file("lines")), 0, kLineCount);
}

TEST(NdjsonSinks, AppSinkReceivesOneLinePerBuffer) {
  Pipeline pipeline(kLines + "appsink name=out");
  const auto sink = pipeline.element("out");
  pipeline.play();
  std::string text;
  std::size_t buffers = 0;
  while (true) {
    GstSample* sample = nullptr;
    g_signal_emit_by_name(sink.get(), "pull-sample", &sample);
    if (sample == nullptr) break;
    EXPECT_TRUE(gst_structure_has_name(gst_caps_get_structure(gst_sample_get_caps(sample), 0),
                                       "application/x-ndjson"));
    text += support::bytes_of(gst_sample_get_buffer(sample));
    EXPECT_EQ(count_lines(text), ++buffers);
    gst_sample_unref(sample);
  }
  expect_frames(text, 0, kLineCount);
}

TEST(NdjsonSinks, FdSinkIntoAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  EXPECT_EQ(run_pipeline(kLines + "fdsink fd=" + std::to_string(ends[1])), "");
  close(ends[1]);
  std::string text;
  std::array<char, 4096> bytes;
  for (ssize_t size; (size = read(ends[0], bytes.data(), bytes.size())) > 0;) {
    text.append(bytes.data(), static_cast<std::size_t>(size));
  }
  close(ends[0]);
  expect_frames(text, 0, kLineCount);
}

TEST(NdjsonSinks, UdpSinkSendsOneLinePerDatagram) {
  Socket receiver(G_SOCKET_TYPE_DATAGRAM);
  const std::string port = std::to_string(receiver.bind());
  ASSERT_EQ(run_pipeline(kLines + "udpsink host=127.0.0.1 port=" + port), "");
  std::string text;
  for (std::size_t i = 0; i < kLineCount; ++i) {
    const std::string datagram = receiver.receive();
    EXPECT_EQ(count_lines(datagram), 1U);
    text += datagram;
  }
  expect_frames(text, 0, kLineCount);
}

TEST(NdjsonSinks, TcpServerSinkServesEachClientFromItsConnectionOn) {
  Server server(kLines);
  Socket early(G_SOCKET_TYPE_STREAM);
  Socket late(G_SOCKET_TYPE_STREAM);
  server.accept(early);
  server.hold(20, 2);
  server.play();
  std::string all;
  early.receive_lines(all, 20);
  server.accept(late);
  ASSERT_EQ(server.wait_for_end(), "");
  early.receive_lines(all, kLineCount);
  expect_frames(all, 0, kLineCount);
  std::string rest;
  late.receive_lines(rest, kLineCount - 20);
  expect_frames(rest, 20, kLineCount - 20);
}

// Lines of about 16 KB each, 16 MB in total: more than the system buffers for a client.
constexpr std::size_t kLongLines = 1000;
const std::string kManyBytes =
    "videotestsrc pattern=black num-buffers=" + std::to_string(kLongLines) +
    " ! video/x-raw,format=GRAY8,width=16,height=16 ! ellipsejson name=json ! ";

GstPadProbeReturn add_ellipses(GstPad*, GstPadProbeInfo* info, gpointer) {
  GstBuffer* buffer = gst_buffer_make_writable(GST_PAD_PROBE_INFO_BUFFER(info));
  for (int i = 0; i < 100; ++i) gst_buffer_add_ellipse_meta(buffer, GST_ELLIPSE_ROLE_TARGET);
  GST_PAD_PROBE_INFO_DATA(info) = buffer;
  return GST_PAD_PROBE_OK;
}

TEST(NdjsonSinks, TcpServerSinkIsNotBlockedByStalledClients) {
  Server server(kManyBytes);
  server.probe("json", add_ellipses, nullptr);
  Socket silent(G_SOCKET_TYPE_STREAM);
  Socket reader(G_SOCKET_TYPE_STREAM);
  silent.keep_little_unread();
  server.accept(silent);
  server.accept(reader);
  server.play();
  std::string text;
  reader.receive_lines(text, kLongLines);
  expect_frames(text, 0, kLongLines);
  EXPECT_EQ(server.wait_for_end(), "");
  EXPECT_GT(server.number("buffers-queued"), 100U);  // kept for the other client
}

TEST(NdjsonSinks, TcpServerSinkDropsStalledClientsWithUnitsMax) {
  Server server(kManyBytes, "units-max=300");
  server.probe("json", add_ellipses, nullptr);
  Socket silent(G_SOCKET_TYPE_STREAM);
  silent.keep_little_unread();
  server.accept(silent);
  server.play();
  EXPECT_EQ(server.wait_for_end(), "");
  server.wait_for_clients(0);
  EXPECT_LE(server.number("buffers-queued"), 301U);
}

TEST(NdjsonSinks, FdSinkToMosquittoPub) {
  const std::string mosquitto = program("mosquitto");
  if (mosquitto.empty() || program("mosquitto_pub").empty()) {
    GTEST_SKIP() << "mosquitto or mosquitto-clients is not installed";
  }
  const Broker broker(mosquitto);
  ASSERT_TRUE(broker.subscribe());
  support::Pipe lines;
  support::ChildProcess publisher(
      {.arguments = {"sh", "-c", "exec mosquitto_pub -l" + broker.address()},
       .input = lines.out.number()});
  EXPECT_EQ(run_pipeline(kLines + "fdsink fd=" + std::to_string(lines.in.number())), "");
  lines.in.close();
  EXPECT_EQ(publisher.wait(), 0);
  expect_frames(broker.read(kLineCount), 0, kLineCount);
}

// Without the reservation, some of so many random numbers would collide.
TEST(OwnPort, IsUnique) {
  std::set<int> numbers;
  std::vector<std::unique_ptr<support::OwnPort>> ports;
  for (int i = 0; i < 500; ++i) {
    ports.push_back(std::make_unique<support::OwnPort>());
    EXPECT_TRUE(numbers.insert(ports.back()->number()).second);
  }
}

TEST(OwnPort, UsedPortsAreNotFree) {
  for (const GSocketType type : {G_SOCKET_TYPE_STREAM, G_SOCKET_TYPE_DATAGRAM}) {
    Socket socket(type);
    EXPECT_FALSE(support::is_free(socket.bind()));
  }
}

// A German locale, with decimal commas; created if the system does not have it.
class German {
 public:
  German() {
    if (std::setlocale(LC_ALL, kName) != nullptr) return;
    const std::string command =
        "localedef -i de_DE -f UTF-8 " + folder_.file(kName) + " > /dev/null 2>&1";
    if (support::run_shell(command).status != 0) return;
    g_setenv("LOCPATH", folder_.file("").c_str(), TRUE);
    std::setlocale(LC_ALL, kName);
  }
  ~German() {
    g_unsetenv("LOCPATH");
    std::setlocale(LC_ALL, before_.c_str());
  }
  German(const German&) = delete;
  German& operator=(const German&) = delete;

  [[nodiscard]] bool is_spoken() const { return *std::localeconv()->decimal_point == ','; }

 private:
  static constexpr char kName[] = "de_DE.UTF-8";
  const std::string before_ = std::setlocale(LC_ALL, nullptr);
  TemporaryFolder folder_;
};

std::string lines_of(const std::string& pipeline) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_pipeline(pipeline + "filesink location=" + folder.file("lines")), "");
  return contents_of(folder.file("lines"));
}

// Lines without the processing time, which differs from run to run.
std::string lines_without_times() {
  return lines_of("ellipsetestsrc num-buffers=" + std::to_string(kLineCount) +
                  " ! ellipsetrack ! ellipsejson times=false ! ");
}

TEST(NdjsonLines, CanOmitTheProcessingTimeAlone) {
  const std::string without = lines_without_times();
  EXPECT_EQ(without.find("processing_ns"), std::string::npos);
  EXPECT_EQ(without, lines_without_times());
  EXPECT_EQ(without,
            std::regex_replace(lines_of(kLines), std::regex(",\"processing_ns\":[0-9]+"), ""));
  expect_frames(without, 0, kLineCount);
  // Without a tracker there is no processing time.
  const std::string untracked =
      lines_of("ellipsetestsrc num-buffers=1 ! ellipsejson times=false ! ");
  EXPECT_EQ(untracked.find("processing_ns"), std::string::npos);
  expect_frames(untracked, 0, 1);
}

TEST(NdjsonLines, AreIndependentOfTheLocale) {
  const std::string expected = lines_without_times();
  const German german;
  if (!german.is_spoken()) GTEST_SKIP() << "neither de_DE.UTF-8 nor localedef is here";
  const std::string lines = lines_without_times();
  EXPECT_EQ(lines, expected);
  expect_frames(lines, 0, kLineCount);
}

}  // namespace
