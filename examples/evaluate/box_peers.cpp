// SPDX-License-Identifier: MIT
#include "examples/evaluate/box_peers.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/tracking.hpp>
#include <stdexcept>
#include <string>

namespace evaluate {
namespace {

using Clock = std::chrono::steady_clock;

// Smaller boxes contain too few pixels to track.
constexpr int kMinBoxPx = 8;

cv::Rect box_around(const ellipse::Ellipse& e, const cv::Size& frame) {
  const Eigen::Vector2d half = half_extent(e);
  const cv::Rect2d box(e.cx - half.x(), e.cy - half.y(), 2.0 * half.x(), 2.0 * half.y());
  return cv::Rect(box & cv::Rect2d(0.0, 0.0, frame.width, frame.height));
}

Eigen::Vector2d middle_of(const cv::Rect& box) {
  return {box.x + 0.5 * box.width, box.y + 0.5 * box.height};
}

// Converts to colour, because KCF fails at random on grey pictures (opencv_contrib issues 1991 and
// 3893).
void colour(const cv::Mat& grey, cv::Mat& colour) {
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
}

constexpr std::array kBoxPeerNames = {"kcf", "csrt"};

}  // namespace

bool BoxPeer::begin(const cv::Mat& grey, const ellipse::Ellipse& target) {
  stop();
  const cv::Rect box = box_around(target, grey.size());
  if (std::min(box.width, box.height) < kMinBoxPx) return false;
  colour(grey, colour_);
  tracker_ = make_();
  try {
    tracker_->init(colour_, box);
  } catch (const cv::Exception&) {
    stop();
  }
  first_ = target;
  first_box_ = box_ = box;
  return is_following();
}

BoxPeer::Step BoxPeer::follow(const cv::Mat& grey) {
  colour(grey, colour_);
  cv::Rect box = box_;
  Step step;
  const auto start = Clock::now();
  const bool is_found = update(box);
  step.ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  if (is_found) {
    box_ = box;
    step.target = carried_to(box);
  } else {
    stop();
  }
  return step;
}

bool BoxPeer::update(cv::Rect& box) {
  try {
    if (!tracker_->update(colour_, box)) return false;
  } catch (const cv::Exception&) {
    return false;
  }
  // A box outside the frame means that the target has left it.
  return !(box & cv::Rect({0, 0}, colour_.size())).empty();
}

ellipse::Ellipse BoxPeer::carried_to(const cv::Rect& box) const {
  const double scale = std::sqrt(box.area() / static_cast<double>(first_box_.area()));
  const Eigen::Vector2d center = middle_of(box) + scale * (first_.center() - middle_of(first_box_));
  return {center.x(),
          center.y(),
          scale * first_.semi_major,
          scale * first_.semi_minor,
          first_.angle_rad};
}

std::span<const char* const> box_peer_names() {
  return kBoxPeerNames;
}

BoxPeer make_box_peer(std::string_view name) {
  if (name == "kcf") {
    return BoxPeer([]() -> cv::Ptr<cv::Tracker> { return cv::TrackerKCF::create(); });
  }
  if (name == "csrt") {
    return BoxPeer([]() -> cv::Ptr<cv::Tracker> { return cv::TrackerCSRT::create(); });
  }
  throw std::invalid_argument("unknown peer \"" + std::string(name) + "\"");
}

}  // namespace evaluate
