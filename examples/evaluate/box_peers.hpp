#pragma once  // SPDX-License-Identifier: MIT

#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "core/geometry/ellipse.hpp"

namespace cv {
class Tracker;
}

namespace evaluate {

/// A packaged box tracker with OpenCV's default settings. The ellipse moves and scales with the
/// box. Not thread-safe. No picture throws: an exception from OpenCV counts as a loss.
class BoxPeer {
 public:
  using Make = cv::Ptr<cv::Tracker> (*)();

  explicit BoxPeer(Make make) : make_(make) {}

  /// The result for one picture.
  struct Step {
    std::optional<ellipse::Ellipse> target;  ///< [px]; nullopt on a loss.
    double ms = 0.0;                         ///< Duration of OpenCV's update() alone.
  };

  /// Initializes the tracker with the target's bounding box, clipped to the picture.
  /// @param grey  8-bit; borrowed for the call.
  /// @return false if the box is too small to track.
  [[nodiscard]] bool begin(const cv::Mat& grey, const ellipse::Ellipse& target);

  [[nodiscard]] bool is_following() const { return !tracker_.empty(); }

  /// Tracks into the next picture. Requires an initialized tracker that has not lost its target.
  [[nodiscard]] Step follow(const cv::Mat& grey);

  void stop() { tracker_.reset(); }

 private:
  [[nodiscard]] bool update(cv::Rect& box);
  [[nodiscard]] ellipse::Ellipse carried_to(const cv::Rect& box) const;

  Make make_;
  cv::Mat colour_;
  cv::Ptr<cv::Tracker> tracker_;  // null = not tracking
  ellipse::Ellipse first_;
  cv::Rect first_box_;
  cv::Rect box_;
};

/// Names: "kcf" and "csrt".
[[nodiscard]] std::span<const char* const> box_peer_names();

/// Creates a tracker. Throws std::invalid_argument that names an unknown one.
[[nodiscard]] BoxPeer make_box_peer(std::string_view name);

}  // namespace evaluate
