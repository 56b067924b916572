// SPDX-License-Identifier: MIT
#include "examples/evaluate/method.hpp"

#include <chrono>
#include <map>
#include <stdexcept>
#include <string_view>

#include "core/detection/target_selection.hpp"
#include "examples/evaluate/box_peers.hpp"
#include "examples/evaluate/command_peer.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/peer_detection.hpp"
#include "examples/evaluate/peers.hpp"

namespace evaluate {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<ellipse::Ellipse> outlines_of(std::span<const ellipse::Detection> detections) {
  std::vector<ellipse::Ellipse> outlines;
  for (const ellipse::Detection& detection : detections) outlines.push_back(detection.ellipse);
  return outlines;
}

class TrackerMethod : public Method {
 public:
  TrackerMethod(const std::string& name, const ellipse::TrackerSettings& settings, int finest_scale)
      : Method(name),
        settings_(settings),
        finest_scale_(finest_scale),
        knows_lens_(true),
        tracker_(settings) {
    ellipse::TrackerSettings all = settings;
    all.wants_candidates = true;
    if (settings.tracking == ellipse::TrackingMode::kNone) all_finder_.emplace(all);
  }
  TrackerMethod(const std::string& name,
                const ellipse::TrackerSettings& settings,
                std::unique_ptr<ellipse::Detector> detector)
      : Method(name), settings_(settings), tracker_(settings, std::move(detector)) {}

  void start(const DistortedFrame* distortion) override {
    if (knows_lens_) {
      ellipse::TrackerSettings settings = settings_;
      if (distortion != nullptr) settings.camera = distortion->lens().camera();
      tracker_.configure(settings);
      settings.wants_candidates = true;
      if (all_finder_) all_finder_->configure(settings);
    }
    tracker_.reset();
  }

  [[nodiscard]] bool knows_lens() const override { return knows_lens_; }

  Answer find(const Frame& /*frame*/, const cv::Mat& picture, std::int64_t pts_ns) override {
    picture_ = picture;
    const ellipse::ImageView view = view_of(picture);
    Answer answer;
    const auto start = Clock::now();
    const std::optional<ellipse::Target> target = tracker_.process(view, pts_ns, scope_in(view));
    const std::chrono::duration<double, std::milli> elapsed = Clock::now() - start;
    answer.processing_ms = elapsed.count();
    answer.tracker = TrackerReport{tracker_.state(), std::nullopt};
    if (target) {
      answer.target = target->ellipse;
      answer.scale = target->scale;
      answer.tracker->probability = target->probability;
    }
    return answer;
  }

  // Detects again in the whole frame, because the search for a single target may stop early.
  [[nodiscard]] std::optional<std::vector<ellipse::Ellipse>> all_found() override {
    if (settings_.tracking != ellipse::TrackingMode::kNone) return std::nullopt;
    if (!all_finder_) return outlines_of(tracker_.candidates());
    const ellipse::ImageView view = view_of(picture_);
    (void)all_finder_->process(view, -1, scope_in(view));
    return outlines_of(all_finder_->candidates());
  }

 private:
  static ellipse::ImageView view_of(const cv::Mat& picture) {
    return {picture.data, picture.cols, picture.rows, static_cast<std::ptrdiff_t>(picture.step)};
  }

  [[nodiscard]] ellipse::SearchScope scope_in(const ellipse::ImageView& view) const {
    return {.within = view.bounds(), .finest_scale = finest_scale_};
  }

  ellipse::TrackerSettings settings_;
  int finest_scale_ = 1;
  bool knows_lens_ = false;  // peers assume a pinhole camera
  ellipse::Tracker tracker_;
  std::optional<ellipse::Tracker> all_finder_;
  cv::Mat picture_;  // picture of the last frame; shares its pixels
};

// Box trackers cannot detect. They are initialized with the truth in the first frame that shows
// enough of the target, and again after each loss.
class BoxMethod : public Method {
 public:
  explicit BoxMethod(const char* peer) : Method(peer), peer_(make_box_peer(peer)) {}

  void start(const DistortedFrame* distortion) override {
    distortion_ = distortion;
    peer_.stop();
  }

  Answer find(const Frame& frame, const cv::Mat& picture, std::int64_t /*pts_ns*/) override {
    Answer answer;
    if (peer_.is_following()) {
      const BoxPeer::Step step = peer_.follow(picture);
      answer.target = step.target;
      answer.processing_ms = step.ms;
      return answer;
    }
    answer.processing_ms = kNaN;
    const bool is_enough = frame.truth.is_labelled &&
                           visible_part(frame.truth, {picture.cols, picture.rows}) >= kMinToStart;
    if (!is_enough) return answer;
    const auto truth =
        distortion_ != nullptr ? distortion_->to_picture(*frame.truth.target) : frame.truth.target;
    if (truth && peer_.begin(picture, *truth)) {
      answer.target = truth;
      answer.is_given = true;
    }
    return answer;
  }

 private:
  const DistortedFrame* distortion_ = nullptr;
  BoxPeer peer_;
};

// Returns answers that were computed in advance.
class CommandMethod : public Method {
 public:
  CommandMethod(const std::string& name, std::map<std::string, PeerAnswer> answers)
      : Method(name), answers_(std::move(answers)) {}

  Answer find(const Frame& frame, const cv::Mat& /*picture*/, std::int64_t /*pts_ns*/) override {
    const auto found = answers_.find(frame.image.string());
    Answer answer;
    answer.processing_ms = kNaN;
    detections_.clear();
    if (found == answers_.end()) return answer;
    answer.processing_ms = found->second.ms;
    detections_ = found->second.detections;
    std::erase_if(detections_, [](const ellipse::Detection& detection) {
      return !ellipse::Thresholds().accepts_axes(detection.ellipse);
    });
    if (const auto target = ellipse::select_target(detections_)) {
      answer.target = target->ellipse;
    }
    return answer;
  }

  [[nodiscard]] std::optional<std::vector<ellipse::Ellipse>> all_found() override {
    return outlines_of(detections_);
  }

 private:
  std::map<std::string, PeerAnswer> answers_;
  std::vector<ellipse::Detection> detections_;  // of the last frame
};

constexpr std::string_view kPapersDetector = "contours";
constexpr std::string_view kOurTracking = "edges";

struct OwnMethod {
  std::string name;
  const char* detector;
  const char* tracking;
};

// All pairs of detector and tracking mode; the default pair first.
std::vector<OwnMethod> own_methods() {
  const ellipse::TrackerSettings defaults;
  std::vector<OwnMethod> methods;
  for (const char* detector : ellipse::detector_nicks()) {
    for (const char* tracking : ellipse::tracking_nicks()) {
      ellipse::TrackerSettings settings;
      ellipse::set_by_name(settings, "detector", detector);
      ellipse::set_by_name(settings, "tracking", tracking);
      const OwnMethod method{std::string(detector) + "+" + tracking, detector, tracking};
      methods.insert(settings == defaults ? methods.begin() : methods.end(), method);
    }
  }
  return methods;
}

}  // namespace

std::unique_ptr<Method> make_tracker_method(const std::string& name,
                                            const ellipse::TrackerSettings& settings,
                                            int finest_scale) {
  return std::make_unique<TrackerMethod>(name, settings, finest_scale);
}

std::vector<std::string> unaided_method_names() {
  std::vector<std::string> names;
  for (const OwnMethod& own : own_methods()) names.push_back(own.name);
  for (const char* peer : peer_names()) names.emplace_back(peer);
  return names;
}

std::vector<std::string> default_method_names() {
  const OwnMethod tracked = own_methods().front();
  return {tracked.name, std::string(tracked.detector) + "+none"};
}

std::vector<std::string> method_names() {
  std::vector<std::string> names = unaided_method_names();
  for (const char* peer : box_peer_names()) names.emplace_back(peer);
  return names;
}

bool is_ours(const std::string& name) {
  for (const OwnMethod& own : own_methods()) {
    const bool is_named = own.name == name;
    if (is_named) return own.detector != kPapersDetector || own.tracking == kOurTracking;
  }
  return false;
}

ellipse::TrackerSettings settings_of(const std::string& name, ellipse::TrackerSettings settings) {
  for (const OwnMethod& own : own_methods()) {
    if (own.name != name) continue;
    ellipse::set_by_name(settings, "detector", own.detector);
    ellipse::set_by_name(settings, "tracking", own.tracking);
    return settings;
  }
  throw std::invalid_argument("method \"" + name + "\" has no settings");
}

std::unique_ptr<Method> make_method(const std::string& name,
                                    ellipse::TrackerSettings settings,
                                    int finest_scale) {
  for (const OwnMethod& own : own_methods()) {
    if (own.name != name) continue;
    return make_tracker_method(name, settings_of(name, settings), finest_scale);
  }
  for (const char* peer : peer_names()) {
    if (name != peer) continue;
    ellipse::TrackerSettings single_frames;
    single_frames.tracking = ellipse::TrackingMode::kNone;
    return std::make_unique<TrackerMethod>(name, single_frames, make_peer(peer));
  }
  for (const char* peer : box_peer_names()) {
    if (name == peer) return std::make_unique<BoxMethod>(peer);
  }
  std::string names;
  for (const std::string& known : method_names()) names += (names.empty() ? "" : ", ") + known;
  throw std::invalid_argument("method \"" + name + "\" is not one of: " + names);
}

PeerCommand parse_peer(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw std::invalid_argument("--peer " + text + ": expected NAME=COMMAND");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::unique_ptr<Method> make_command_method(const PeerCommand& peer,
                                            std::span<const Sequence> sequences,
                                            std::vector<std::string>& problems,
                                            const std::function<bool()>& is_wanted) {
  std::vector<std::filesystem::path> images;
  for (const Sequence& sequence : sequences) {
    for (const Frame& frame : sequence.frames) images.push_back(frame.image);
  }
  auto answers = run_command_peer(peer.command, images, is_wanted);
  if (answers.size() < images.size()) {
    problems.push_back("peer " + peer.name + ": no answer for " +
                       std::to_string(images.size() - answers.size()) + " of " +
                       std::to_string(images.size()) + " images; counted as no detection");
  }
  return std::make_unique<CommandMethod>(peer.name, std::move(answers));
}

}  // namespace evaluate
