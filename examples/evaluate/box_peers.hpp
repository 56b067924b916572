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

/// A packaged tracker of boxes with OpenCV's defaults, and an ellipse that is moved and scaled with
/// its box. One object serves one thread at a time. No content of a picture throws: where OpenCV
/// does, that is a loss.
class BoxPeer {
 public:
  using Make = cv::Ptr<cv::Tracker> (*)();

  explicit BoxPeer(Make make) : make_(make) {}

  /// What it makes of one picture.
  struct Step {
    std::optional<ellipse::Ellipse> target;  ///< [px]. nullopt where it reports a loss.
    double ms = 0.0;                         ///< Of OpenCV's update alone.
  };

  /// Starts from a target's box, cut at the picture's border.
  /// @param grey  8 bits, borrowed for the call only.
  /// @return Whether there is anything to follow: too small a box is refused.
  [[nodiscard]] bool begin(const cv::Mat& grey, const ellipse::Ellipse& target);

  [[nodiscard]] bool is_following() const { return !tracker_.empty(); }

  /// The next picture. Only while it is following, which ends with a loss.
  [[nodiscard]] Step follow(const cv::Mat& grey);

  void stop() { tracker_.reset(); }

 private:
  [[nodiscard]] bool update(cv::Rect& box);
  [[nodiscard]] ellipse::Ellipse carried_to(const cv::Rect& box) const;

  Make make_;
  cv::Mat colour_;
  cv::Ptr<cv::Tracker> tracker_;  // none while there is nothing to follow
  ellipse::Ellipse first_;
  cv::Rect first_box_;
  cv::Rect box_;
};

/// "kcf" and "csrt".
[[nodiscard]] std::span<const char* const> box_peer_names();

/// One of them. Throws std::invalid_argument that names it, where it is unknown.
[[nodiscard]] BoxPeer make_box_peer(std::string_view name);

}  // namespace evaluate
