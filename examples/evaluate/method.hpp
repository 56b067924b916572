#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/tracking/tracker.hpp"
#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/measures.hpp"

namespace evaluate {

/// A method's answer for one frame.
struct Answer {
  std::optional<ellipse::Ellipse> target;
  int scale = 1;               ///< Frame scale of the answer.
  double processing_ms = 0.0;  ///< NaN if not measured.
  bool is_given = false;       ///< The answer is the truth that initialized the method.
  std::optional<TrackerReport> tracker = {};
};

/// A method that finds the target in a sequence.
class Method {
 public:
  explicit Method(std::string name) : name_(std::move(name)) {}
  virtual ~Method() = default;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Called before the first frame of each sequence.
  /// @param distortion  The frames' lens distortion; nullptr for a pinhole camera. Borrowed until
  /// the next call.
  virtual void start(const DistortedFrame* /*distortion*/) {}
  /// Whether answers are in the ideal plane; otherwise they are in the distorted picture.
  [[nodiscard]] virtual bool knows_lens() const { return false; }
  [[nodiscard]] virtual Answer find(const Frame& frame,
                                    const cv::Mat& picture,
                                    std::int64_t pts_ns) = 0;
  /// All ellipses in the last frame, in the coordinates of find(); nullopt if the method finds only
  /// its target.
  [[nodiscard]] virtual std::optional<std::vector<ellipse::Ellipse>> all_found() {
    return std::nullopt;
  }

 private:
  std::string name_;
};

/// One of our methods, by the names of detector and tracking mode.
[[nodiscard]] std::unique_ptr<Method> make_tracker_method(const std::string& name,
                                                          const ellipse::TrackerSettings& settings,
                                                          int finest_scale = 1);

/// The names of methods that find their target themselves: "contours+redetect" and so on, then the
/// packaged detectors.
[[nodiscard]] std::vector<std::string> unaided_method_names();

/// The default pair of detector and tracking mode, and its detector on single frames.
[[nodiscard]] std::vector<std::string> default_method_names();

/// The names of all methods: those that find their target themselves, then the packaged trackers,
/// which are initialized with the truth.
[[nodiscard]] std::vector<std::string> method_names();

/// Whether the method uses our detector or our tracker, alone or combined with the paper's. All
/// others, including the paper's method, are peers.
[[nodiscard]] bool is_ours(const std::string& name);

/// The settings of one of our methods or the paper's, by name. Throws std::invalid_argument for
/// other methods, which have no settings.
[[nodiscard]] ellipse::TrackerSettings settings_of(const std::string& name,
                                                   ellipse::TrackerSettings settings);

/// Creates a method by name. The packaged detectors process single frames and choose their target
/// as our detectors do. The packaged trackers are initialized with the truth in the first frame
/// that shows at least kMinToStart of the perimeter, and again after they report a loss; such an
/// answer has is_given set and no time.
/// @param settings      For our methods; detector and tracking mode come from the name.
/// @param finest_scale  Of our methods: SearchScope::finest_scale.
/// Throws std::invalid_argument that lists the names if it is unknown.
[[nodiscard]] std::unique_ptr<Method> make_method(const std::string& name,
                                                  ellipse::TrackerSettings settings,
                                                  int finest_scale = 1);

/// Another program as a method.
struct PeerCommand {
  std::string name;
  std::string command;
};

/// Parses "NAME=COMMAND". Throws std::invalid_argument if the text has another form.
[[nodiscard]] PeerCommand parse_peer(const std::string& text);

/// Creates a method that runs a program once for all frames.
/// @param problems   Receives one message with the number of missing answers, if any.
/// @param is_wanted  Called from another thread from time to time; returning false kills the
/// program.
/// Throws std::runtime_error that names the command.
[[nodiscard]] std::unique_ptr<Method> make_command_method(const PeerCommand& peer,
                                                          std::span<const Sequence> sequences,
                                                          std::vector<std::string>& problems,
                                                          const std::function<bool()>& is_wanted);

}  // namespace evaluate
