// SPDX-License-Identifier: MIT
#include "examples/evaluate/command_peer.hpp"

#include <gio/gio.h>
#include <json-glib/json-glib.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "examples/evaluate/peer_detection.hpp"

namespace evaluate {
namespace {

constexpr std::size_t kShownOfALine = 80;

template <auto kFree>
struct Free {
  void operator()(auto* owned) const { kFree(owned); }
};
template <class T>
using ObjectPtr = std::unique_ptr<T, Free<g_object_unref>>;
using BytesPtr = std::unique_ptr<GBytes, Free<g_bytes_unref>>;
using WordsPtr = std::unique_ptr<gchar*, Free<g_strfreev>>;

[[noreturn]] void fail(const std::string& command, const std::string& what) {
  throw std::runtime_error("peer \"" + command + "\": " + what);
}

[[noreturn]] void fail(const std::string& command, GError* error) {
  const std::string what = error->message;
  g_error_free(error);
  fail(command, what);
}

// Ignores SIGPIPE: a program that exits before it has read its input must not kill this one.
class IgnoredPipeSignal {
 public:
  IgnoredPipeSignal() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
  ~IgnoredPipeSignal() { std::signal(SIGPIPE, before_); }
  IgnoredPipeSignal(const IgnoredPipeSignal&) = delete;
  IgnoredPipeSignal& operator=(const IgnoredPipeSignal&) = delete;

 private:
  void (*before_)(int);
};

ObjectPtr<GSubprocess> start(const std::string& command) {
  gchar** words = nullptr;
  GError* error = nullptr;
  if (!g_shell_parse_argv(command.c_str(), nullptr, &words, &error)) fail(command, error);
  const WordsPtr owned_words(words);
  constexpr auto kPipes =
      static_cast<GSubprocessFlags>(G_SUBPROCESS_FLAGS_STDIN_PIPE | G_SUBPROCESS_FLAGS_STDOUT_PIPE);
  const ObjectPtr<GSubprocessLauncher> launcher(g_subprocess_launcher_new(kPipes));
  g_subprocess_launcher_set_child_setup(
      launcher.get(), [](gpointer) { setpgid(0, 0); }, nullptr, nullptr);
  ObjectPtr<GSubprocess> program(g_subprocess_launcher_spawnv(launcher.get(), words, &error));
  if (!program) fail(command, error);
  return program;
}

void check_status(const std::string& command, GSubprocess* program) {
  g_subprocess_wait(program, nullptr, nullptr);
  if (g_subprocess_get_if_signaled(program)) {
    fail(command, "was killed by signal " + std::to_string(g_subprocess_get_term_sig(program)));
  }
  const int status = g_subprocess_get_exit_status(program);
  if (status != 0) fail(command, "exited with status " + std::to_string(status));
}

// Kills the program when is_wanted() returns false.
class Watch {
 public:
  Watch(GSubprocess* program, const std::function<bool()>& is_wanted)
      : thread_([program, &is_wanted](const std::stop_token& stop) {
          while (!stop.stop_requested() && is_wanted()) g_usleep(kPollUs);
          if (!stop.stop_requested()) g_subprocess_force_exit(program);
        }) {}

 private:
  static constexpr gulong kPollUs = 20'000;
  std::jthread thread_;
};

// Writes and reads concurrently, so that neither program blocks the other.
std::string output_of(const std::string& command,
                      const std::string& input,
                      const std::function<bool()>& is_wanted) {
  const IgnoredPipeSignal no_signal;
  const ObjectPtr<GSubprocess> program = start(command);
  const Watch watch(program.get(), is_wanted);
  const BytesPtr in(g_bytes_new(input.data(), input.size()));
  GBytes* out = nullptr;
  GError* error = nullptr;
  if (!g_subprocess_communicate(program.get(), in.get(), nullptr, &out, nullptr, &error)) {
    const bool stopped_reading = g_error_matches(error, G_IO_ERROR, G_IO_ERROR_BROKEN_PIPE);
    if (!stopped_reading) g_subprocess_force_exit(program.get());
    if (!stopped_reading) fail(command, error);
    g_error_free(error);
    check_status(command, program.get());
    fail(command, "did not read all of its input");
  }
  const BytesPtr owned_out(out);
  check_status(command, program.get());
  gsize size = 0;
  const auto* data = static_cast<const char*>(g_bytes_get_data(out, &size));
  return size > 0 ? std::string(data, size) : std::string();
}

std::optional<double> number_in(JsonNode* node) {
  if (node == nullptr || !JSON_NODE_HOLDS_VALUE(node)) return std::nullopt;
  const GType type = json_node_get_value_type(node);
  if (type != G_TYPE_DOUBLE && type != G_TYPE_INT64) return std::nullopt;
  const double value = json_node_get_double(node);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<ellipse::Detection> detection_in(JsonNode* node) {
  if (!JSON_NODE_HOLDS_ARRAY(node)) return std::nullopt;
  JsonArray* fields = json_node_get_array(node);
  std::array<double, 5> values{};
  if (json_array_get_length(fields) != values.size()) return std::nullopt;
  for (guint i = 0; i < values.size(); ++i) {
    const auto value = number_in(json_array_get_element(fields, i));
    if (!value) return std::nullopt;
    values[i] = *value;
  }
  const auto e = ellipse_of_axes(values[0], values[1], values[2], values[3], values[4]);
  return e ? std::optional(scored_by_perimeter(*e)) : std::nullopt;
}

struct NamedAnswer {
  std::string image;
  PeerAnswer answer;
};

// Throws std::invalid_argument that describes the error in the line.
NamedAnswer answer_in(std::string_view line) {
  const ObjectPtr<JsonParser> parser(json_parser_new());
  JsonNode* root = nullptr;
  if (json_parser_load_from_data(
          parser.get(), line.data(), static_cast<gssize>(line.size()), nullptr)) {
    root = json_parser_get_root(parser.get());
  }
  if (root == nullptr || !JSON_NODE_HOLDS_OBJECT(root)) {
    throw std::invalid_argument("is not a JSON object");
  }
  JsonObject* object = json_node_get_object(root);
  JsonNode* image = json_object_get_member(object, "image");
  if (image == nullptr || json_node_get_value_type(image) != G_TYPE_STRING) {
    throw std::invalid_argument("has no string \"image\"");
  }
  const auto ms = number_in(json_object_get_member(object, "ms"));
  if (!ms || *ms < 0.0) throw std::invalid_argument("has no time \"ms\"");
  JsonNode* ellipses = json_object_get_member(object, "ellipses");
  if (ellipses == nullptr || !JSON_NODE_HOLDS_ARRAY(ellipses)) {
    throw std::invalid_argument("has no list \"ellipses\"");
  }
  NamedAnswer named{json_node_get_string(image), {*ms, {}}};
  JsonArray* list = json_node_get_array(ellipses);
  for (guint i = 0; i < json_array_get_length(list); ++i) {
    const auto detection = detection_in(json_array_get_element(list, i));
    if (!detection) throw std::invalid_argument("contains an invalid ellipse");
    named.answer.detections.push_back(*detection);
  }
  return named;
}

std::map<std::string, PeerAnswer> answers_in(const std::string& output,
                                             const std::set<std::string>& asked) {
  std::map<std::string, PeerAnswer> answers;
  std::istringstream lines(output);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      NamedAnswer named = answer_in(line);
      if (!asked.contains(named.image))
        throw std::invalid_argument("names an image that was not requested");
      if (!answers.emplace(named.image, std::move(named.answer)).second) {
        throw std::invalid_argument("names an image twice");
      }
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("line " + std::to_string(number) + " of its answer " +
                                  error.what() + ": " + line.substr(0, kShownOfALine));
    }
  }
  return answers;
}

}  // namespace

std::map<std::string, PeerAnswer> run_command_peer(const std::string& command,
                                                   std::span<const std::filesystem::path> images,
                                                   const std::function<bool()>& is_wanted) {
  std::set<std::string> asked;
  std::string input;
  for (const std::filesystem::path& image : images) {
    if (image.string().find('\n') != std::string::npos) {
      fail(command, "cannot be passed \"" + image.string() + "\": the path contains a line break");
    }
    if (asked.insert(image.string()).second) input += image.string() + '\n';
  }
  try {
    return answers_in(output_of(command, input, is_wanted), asked);
  } catch (const std::invalid_argument& error) {
    fail(command, error.what());
  }
}

}  // namespace evaluate
