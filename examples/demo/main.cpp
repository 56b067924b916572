// SPDX-License-Identifier: MIT
//
// ellipse-demo: runs the tracker on a test scene, a file, pictures, a camera or a URI, and writes
// the annotated video, the JSON lines and a contact sheet.
#include <gst/app/app.h>
#include <gst/gst.h>
#include <gst/video/video.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr int kCameraFrames = 300;
constexpr int kSheetColumns = 4;
constexpr int kSheetRows = 3;
constexpr int kThumbnailWidth = 480;

struct Options {
  std::string input;
  std::string output = "out";
  int frames = 0;  // 0 = all; kCameraFrames for a camera, 600 for the test scene
};

std::string quoted(const std::string& text) {
  std::ostringstream quoted_text;
  quoted_text << std::quoted(text);
  return quoted_text.str();
}

// The smallest index for which a picture of a printf pattern such as frame%04d.jpg exists.
int first_index(const std::string& pattern) {
  constexpr int kMaxTried = 100'000;
  for (int i = 0; i < kMaxTried; ++i) {
    const int length = std::snprintf(nullptr, 0, pattern.c_str(), i);
    std::string name(static_cast<std::size_t>(length), '\0');
    std::snprintf(name.data(), name.size() + 1, pattern.c_str(), i);
    if (fs::exists(name)) return i;
  }
  throw std::runtime_error("no such picture");
}

// Whether the input contains exactly one integer conversion, so that it is a safe printf format.
bool is_picture_pattern(const std::string& input) {
  const std::size_t percent = input.find('%');
  if (percent == std::string::npos || input.find('%', percent + 1) != std::string::npos) {
    return false;
  }
  const std::size_t end = input.find_first_not_of("0123456789", percent + 1);
  return end != std::string::npos && input[end] == 'd';
}

std::string picture_source(const std::string& pattern) {
  const std::string extension = fs::path(pattern).extension().string();
  const bool is_png = extension == ".png" || extension == ".PNG";
  return "multifilesrc location=" + quoted(pattern) +
         " start-index=" + std::to_string(first_index(pattern)) +
         " caps=" + (is_png ? "image/png" : "image/jpeg") + ",framerate=30/1 ! " +
         (is_png ? "pngdec" : "jpegdec");
}

// (ANY) is required because libav's decoders also offer interlaced fields as a caps feature, and
// uridecodebin uses a decoder only if the caps cover everything it offers.
std::string uri_source(const std::string& uri) {
  return "uridecodebin uri=" + quoted(uri) + " caps=\"video/x-raw(ANY)\" expose-all-streams=false";
}

std::string source_for(const Options& options) {
  const std::string& input = options.input;
  if (input.empty()) {
    return "ellipsetestsrc num-buffers=" +
           std::to_string(options.frames > 0 ? options.frames : 600);
  }
  if (input.starts_with("/dev/")) {
    if (!fs::exists(input)) throw std::runtime_error("no such camera");
    return "v4l2src device=" + quoted(input) +
           " num-buffers=" + std::to_string(options.frames > 0 ? options.frames : kCameraFrames) +
           " ! decodebin";
  }
  if (!fs::exists(input) && is_picture_pattern(input)) return picture_source(input);
  if (input.find("://") != std::string::npos) return uri_source(input);
  if (!fs::exists(input)) throw std::runtime_error("no such file");
  if (fs::is_directory(input)) {
    throw std::runtime_error("is a folder; name its pictures like " + input + "/frame%04d.jpg");
  }
  gchar* uri = gst_filename_to_uri(input.c_str(), nullptr);
  const std::string source = uri_source(uri);
  g_free(uri);
  return source;
}

// Keeps 12 to 23 evenly spaced frames of a stream of unknown length; write() selects 12 of them.
class ContactSheet {
 public:
  void add(const cv::Mat& frame) {
    if (frame_count_++ % step_ != 0) return;
    cv::Mat thumbnail;
    const double scale = static_cast<double>(kThumbnailWidth) / frame.cols;
    cv::resize(frame, thumbnail, {}, scale, scale, scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
    if (!thumbnails_.empty() && thumbnails_.front().size() != thumbnail.size()) return;
    thumbnails_.push_back(thumbnail);
    if (thumbnails_.size() < 2 * kSheetColumns * kSheetRows) return;
    for (std::size_t i = 0; i < thumbnails_.size() / 2; ++i) thumbnails_[i] = thumbnails_[2 * i];
    thumbnails_.resize(thumbnails_.size() / 2);
    step_ *= 2;
  }

  void write(const fs::path& file) const {
    if (thumbnails_.empty()) return;
    const std::size_t wanted = kSheetColumns * kSheetRows;
    const cv::Size size = thumbnails_.front().size();
    cv::Mat sheet = cv::Mat::zeros(kSheetRows * size.height, kSheetColumns * size.width, CV_8UC3);
    for (std::size_t i = 0; i < std::min(wanted, thumbnails_.size()); ++i) {
      const std::size_t from =
          thumbnails_.size() <= wanted ? i : i * (thumbnails_.size() - 1) / (wanted - 1);
      const int column = static_cast<int>(i) % kSheetColumns;
      const int row = static_cast<int>(i) / kSheetColumns;
      thumbnails_[from].copyTo(sheet({{column * size.width, row * size.height}, size}));
    }
    if (!cv::imwrite(file.string(), sheet)) {
      throw std::runtime_error(file.string() + " cannot be written");
    }
  }

  [[nodiscard]] std::size_t frame_count() const { return frame_count_; }

 private:
  std::vector<cv::Mat> thumbnails_;
  std::size_t frame_count_ = 0;
  std::size_t step_ = 1;
};

class Demo {
 public:
  explicit Demo(const Options& options) : options_(options) {
    std::error_code problem;
    fs::create_directories(options.output, problem);
    if (problem) {
      throw std::runtime_error("--out " + options.output + ": " + problem.message());
    }
    const fs::path folder = options.output;
    const std::string description =
        source_for(options) +
        " ! videoconvert ! ellipsetrack name=track ! tee name=analysed "
        "analysed. ! queue ! ellipseoverlay overlay=ellipse+centre+label ! videoconvert "
        "! tee name=drawn "
        "drawn. ! queue ! videoconvert ! jpegenc ! matroskamux ! filesink location=" +
        quoted(folder / "annotated.mkv") +
        " drawn. ! queue ! videoconvert ! video/x-raw,format=BGR ! appsink name=frames sync=false "
        "analysed. ! queue ! ellipsejson ! filesink location=" +
        quoted(folder / "targets.ndjson");
    GError* error = nullptr;
    pipeline_ = gst_parse_launch(description.c_str(), &error);
    if (error != nullptr) {
      const std::string message = error->message;
      g_error_free(error);
      throw std::runtime_error(message);
    }
  }

  ~Demo() {
    gst_element_set_state(pipeline_, GST_STATE_NULL);
    gst_object_unref(pipeline_);
  }

  Demo(const Demo&) = delete;
  Demo& operator=(const Demo&) = delete;

  void run() {
    if (options_.frames > 0) limit_frames();
    gst_element_set_state(pipeline_, GST_STATE_PLAYING);
    GstElement* sink = gst_bin_get_by_name(GST_BIN(pipeline_), "frames");
    const bool is_terminal = isatty(STDERR_FILENO) != 0;
    while (GstSample* sample = next_sample(GST_APP_SINK(sink))) {
      keep(sample);
      gst_sample_unref(sample);
      if (is_terminal && sheet_.frame_count() % 10 == 0) {
        std::fprintf(stderr, "\r%zu frames", sheet_.frame_count());
      }
    }
    if (is_terminal) std::fprintf(stderr, "\r\033[K");
    gst_object_unref(sink);
    await_end();
    sheet_.write(fs::path(options_.output) / "contact_sheet.png");
    if (sheet_.frame_count() == 0) throw std::runtime_error("contains no picture");
  }

  void print_summary() const {
    GstElement* track = gst_bin_get_by_name(GST_BIN(pipeline_), "track");
    GstStructure* stats = nullptr;
    g_object_get(track, "stats", &stats, nullptr);
    const auto number = [&](const char* name) {
      guint64 value = 0;
      gst_structure_get_uint64(stats, name, &value);
      return value;
    };
    const guint64 frames = number("analysed");
    const guint64 found = number("detected") + number("tracked");
    std::printf("frames                %8" G_GUINT64_FORMAT "\n", frames);
    std::printf(
        "with target           %8" G_GUINT64_FORMAT " (%.1f %%)\n",
        found,
        frames > 0 ? 100.0 * static_cast<double>(found) / static_cast<double>(frames) : 0.0);
    std::printf("  of them tracked     %8" G_GUINT64_FORMAT "\n", number("tracked"));
    std::printf("processing time       %8.3f ms median, %.3f ms p99\n",
                static_cast<double>(number("processing-time-median")) * 1e-6,
                static_cast<double>(number("processing-time-p99")) * 1e-6);
    std::printf("written to %s: annotated.mkv, targets.ndjson, contact_sheet.png\n",
                options_.output.c_str());
    gst_structure_free(stats);
    gst_object_unref(track);
  }

 private:
  // Passes the requested number of frames to the tracker, then ends the stream.
  void limit_frames() {
    GstElement* track = gst_bin_get_by_name(GST_BIN(pipeline_), "track");
    GstPad* pad = gst_element_get_static_pad(track, "sink");
    gst_pad_add_probe(pad, GST_PAD_PROBE_TYPE_BUFFER, on_frame, this, nullptr);
    gst_object_unref(pad);
    gst_object_unref(track);
  }

  static GstPadProbeReturn on_frame(GstPad* pad, GstPadProbeInfo*, gpointer data) {
    auto* demo = static_cast<Demo*>(data);
    if (demo->passed_ < demo->options_.frames) {
      ++demo->passed_;
      return GST_PAD_PROBE_OK;
    }
    if (demo->passed_++ == demo->options_.frames) gst_pad_send_event(pad, gst_event_new_eos());
    return GST_PAD_PROBE_DROP;
  }

  // Blocks until the next frame. Returns NULL at the end of the stream.
  GstSample* next_sample(GstAppSink* sink) {
    constexpr GstClockTime kBusPoll = 100 * GST_MSECOND;
    GstSample* sample = nullptr;
    while (sample == nullptr && !gst_app_sink_is_eos(sink)) {
      sample = gst_app_sink_try_pull_sample(sink, kBusPoll);
      watch_bus(0);
    }
    return sample;
  }

  // Throws if the pipeline has failed; records its end.
  void watch_bus(GstClockTime timeout) {
    GstBus* bus = gst_element_get_bus(pipeline_);
    GstMessage* message = gst_bus_timed_pop_filtered(
        bus, timeout, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
    gst_object_unref(bus);
    if (message == nullptr) return;
    if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) fail(message);
    has_ended_ = true;
    gst_message_unref(message);
  }

  [[noreturn]] void fail(GstMessage* message) const {
    GError* error = nullptr;
    gst_message_parse_error(message, &error, nullptr);
    const std::string text = error->message;
    g_error_free(error);
    gst_message_unref(message);
    throw std::runtime_error(text);
  }

  void await_end() {
    if (!has_ended_) watch_bus(10 * GST_SECOND);
    if (!has_ended_) throw std::runtime_error("the pipeline does not reach the end of the stream");
  }

  void keep(GstSample* sample) {
    GstVideoInfo info;
    GstVideoFrame frame;
    if (!gst_video_info_from_caps(&info, gst_sample_get_caps(sample)) ||
        !gst_video_frame_map(&frame, &info, gst_sample_get_buffer(sample), GST_MAP_READ)) {
      return;
    }
    sheet_.add(cv::Mat(GST_VIDEO_FRAME_HEIGHT(&frame),
                       GST_VIDEO_FRAME_WIDTH(&frame),
                       CV_8UC3,
                       GST_VIDEO_FRAME_PLANE_DATA(&frame, 0),
                       static_cast<std::size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&frame, 0))));
    gst_video_frame_unmap(&frame);
  }

  Options options_;
  GstElement* pipeline_ = nullptr;
  ContactSheet sheet_;
  bool has_ended_ = false;
  int passed_ = 0;  // frames passed to the tracker; used by the streaming thread
};

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  Options options;
  CLI::App app{"Runs the ellipse tracker on a video and writes the annotated result."};
  app.name("ellipse-demo");
  app.add_option(
      "INPUT", options.input, "A file, frame%04d.jpg, /dev/video0 or a URI; default: a test scene");
  app.add_option("--out", options.output, "Folder for the results")->capture_default_str();
  app.add_option("--frames",
                 options.frames,
                 "Stop after this number of frames; 0 = process the whole input")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()));
  CLI11_PARSE(app, argc, argv);
  try {
    Demo demo(options);
    demo.run();
    demo.print_summary();
  } catch (const std::exception& error) {
    const std::string what = options.input.empty() ? "the test scene" : options.input;
    std::cerr << "ellipse-demo: " << what << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}
