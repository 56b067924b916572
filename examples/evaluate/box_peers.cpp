// SPDX-License-Identifier: MIT
#include "examples/evaluate/box_peers.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <opencv2/tracking.hpp>
#include <optional>
#include <stdexcept>

#include "examples/evaluate/measures.hpp"

namespace evaluate {
namespace {

using Clock = std::chrono::steady_clock;

// Smaller ones hold nothing to follow, and KCF does not take them.
constexpr int kLeastBoxPx = 8;

cv::Rect box_around(const ellipse::Ellipse& e, const cv::Size& frame) {
  const Eigen::Vector2d half = half_extent(e);
  const cv::Rect2d box(e.cx - half.x(), e.cy - half.y(), 2.0 * half.x(), 2.0 * half.y());
  return cv::Rect(box & cv::Rect2d(0.0, 0.0, frame.width, frame.height));
}

Eigen::Vector2d middle_of(const cv::Rect& box) {
  return {box.x + 0.5 * box.width, box.y + 0.5 * box.height};
}

class BoxMethod final : public Method {
 public:
  using Make = cv::Ptr<cv::Tracker> (*)();

  BoxMethod(const std::string& name, Make make) : Method(name), make_(make) {}

  void start() override { tracker_.reset(); }

  Answer find(const Frame& frame, const cv::Mat& picture, std::int64_t /*pts_ns*/) override {
    // In grey KCF forgets its target at random (opencv_contrib issues 1991 and 3893).
    cv::cvtColor(picture, colour_, cv::COLOR_GRAY2BGR);
    if (!tracker_) return take(frame.truth);
    Answer answer;
    cv::Rect box = box_;
    const auto start = Clock::now();
    const bool is_found = update(box);
    answer.processing_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    if (is_found) {
      answer.target = carried_to(box);
      box_ = box;
    } else {
      tracker_.reset();
    }
    return answer;
  }

 private:
  Answer take(const Truth& truth) {
    Answer answer;
    answer.processing_ms = std::numeric_limits<double>::quiet_NaN();
    const FrameSize size{colour_.cols, colour_.rows};
    if (!truth.is_labelled || visible_part(truth, size) < kLeastToStart) return answer;
    const cv::Rect box = box_around(*truth.target, colour_.size());
    if (std::min(box.width, box.height) < kLeastBoxPx || !init(box)) return answer;
    given_ = *truth.target;
    given_box_ = box_ = box;
    answer.target = given_;
    answer.is_given = true;
    return answer;
  }

  bool init(const cv::Rect& box) {
    tracker_ = make_();
    try {
      tracker_->init(colour_, box);
      return true;
    } catch (const cv::Exception&) {
      tracker_.reset();
      return false;
    }
  }

  bool update(cv::Rect& box) {
    try {
      if (!tracker_->update(colour_, box)) return false;
    } catch (const cv::Exception&) {
      return false;
    }
    // A box outside the frame says that the target has left it.
    return !(box & cv::Rect({0, 0}, colour_.size())).empty();
  }

  [[nodiscard]] ellipse::Ellipse carried_to(const cv::Rect& box) const {
    const double scale = std::sqrt(box.area() / static_cast<double>(given_box_.area()));
    const Eigen::Vector2d center =
        middle_of(box) + scale * (given_.center() - middle_of(given_box_));
    return {center.x(),
            center.y(),
            scale * given_.semi_major,
            scale * given_.semi_minor,
            given_.angle_rad};
  }

  Make make_;
  cv::Mat colour_;
  cv::Ptr<cv::Tracker> tracker_;  // none while there is nothing to follow
  ellipse::Ellipse given_;
  cv::Rect given_box_;
  cv::Rect box_;
};

constexpr std::array kNames = {"kcf", "csrt"};

}  // namespace

std::span<const char* const> box_peer_names() {
  return kNames;
}

std::unique_ptr<Method> make_box_method(std::string_view name) {
  if (name == "kcf") {
    return std::make_unique<BoxMethod>(
        "kcf", []() -> cv::Ptr<cv::Tracker> { return cv::TrackerKCF::create(); });
  }
  if (name == "csrt") {
    return std::make_unique<BoxMethod>(
        "csrt", []() -> cv::Ptr<cv::Tracker> { return cv::TrackerCSRT::create(); });
  }
  throw std::invalid_argument("there is no peer \"" + std::string(name) + "\"");
}

}  // namespace evaluate
