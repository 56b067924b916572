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

namespace evaluate {

/// What a method says of one frame.
struct Answer {
  std::optional<ellipse::Ellipse> target;
  int scale = 1;               ///< Frame scale at which it was found.
  double processing_ms = 0.0;  ///< NaN where nothing was answered.
  bool is_given = false;       ///< The truth, told to a method that cannot find its target.
};

/// A way to find the target in a sequence.
class Method {
 public:
  explicit Method(std::string name) : name_(std::move(name)) {}
  virtual ~Method() = default;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Called before the first frame of each sequence.
  /// @param distortion  What a lens makes of its frames, nullptr for a pinhole. Borrowed until the
  /// next.
  virtual void start(const DistortedFrame* /*distortion*/) {}
  /// Whether its answers are of the ideal plane; else they are of the picture.
  [[nodiscard]] virtual bool knows_lens() const { return false; }
  [[nodiscard]] virtual Answer find(const Frame& frame,
                                    const cv::Mat& picture,
                                    std::int64_t pts_ns) = 0;
  /// All ellipses that it found in the last frame, as those of find(); nullopt where it looks for
  /// its target only.
  [[nodiscard]] virtual std::optional<std::vector<ellipse::Ellipse>> all_found() {
    return std::nullopt;
  }

 private:
  std::string name_;
};

/// Ours, by the names of detector and tracking mode.
[[nodiscard]] std::unique_ptr<Method> make_tracker_method(const std::string& name,
                                                          const ellipse::TrackerSettings& settings);

/// The names of the methods that find their target themselves: "contours+redetect" and so on, then
/// the packaged detectors.
[[nodiscard]] std::vector<std::string> unaided_method_names();

/// Of those, the default pair of detector and tracking mode, and its detector on single frames.
[[nodiscard]] std::vector<std::string> default_method_names();

/// The names of all methods: those that find their target themselves, then the packaged trackers,
/// which are told their target.
[[nodiscard]] std::vector<std::string> method_names();

/// Whether the name is that of our detector or our tracker, alone or with a part of the paper's.
/// All others, the paper's method among them, are peers.
[[nodiscard]] bool is_ours(const std::string& name);

/// The settings of one of ours, by its name. Throws std::invalid_argument where it is none of ours
/// or the paper's: others have no settings.
[[nodiscard]] ellipse::TrackerSettings settings_of(const std::string& name,
                                                   ellipse::TrackerSettings settings);

/// One of them by its name. The packaged detectors look at single frames, and choose their target
/// as ours do. The packaged trackers are told the truth in the first frame that shows at least
/// kMinToStart of the perimeter, and again after they report a loss; such an answer is given, and
/// has no time.
/// @param settings  All but detector and tracking mode, of those of ours.
/// Throws std::invalid_argument that lists the names, where it is unknown.
[[nodiscard]] std::unique_ptr<Method> make_method(const std::string& name,
                                                  ellipse::TrackerSettings settings);

/// Any other program.
struct PeerCommand {
  std::string name;
  std::string command;
};

/// From "NAME=COMMAND". Throws std::invalid_argument where it is something else.
[[nodiscard]] PeerCommand parse_peer(const std::string& text);

/// A method whose answers are all asked for at once.
/// @param problems  What is missing from them is added here.
/// @param is_wanted  Asked from another thread from time to time; false ends the program.
/// Throws std::runtime_error that names the command.
[[nodiscard]] std::unique_ptr<Method> make_command_method(const PeerCommand& peer,
                                                          std::span<const Sequence> sequences,
                                                          std::vector<std::string>& problems,
                                                          const std::function<bool()>& is_wanted);

}  // namespace evaluate
