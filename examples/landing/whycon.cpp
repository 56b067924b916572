// SPDX-License-Identifier: MIT
#include "examples/landing/whycon.hpp"

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/camera/circle_pose.hpp"
#include "core/scene/wild_shapes.hpp"

namespace landing {

// Zeroth to second moments of pixels, and their mean brightness.
class Blob {
 public:
  void add(const Eigen::Vector2d& pixel, double level) {
    if (count_ == 0.0) origin_ = pixel;  // relative coordinates preserve precision
    const Eigen::Vector2d p = pixel - origin_;
    count_ += 1.0;
    sum_ += p;
    squares_ += p * p.transpose();
    levels_ += level;
  }

  [[nodiscard]] double area() const { return count_; }
  [[nodiscard]] double level() const { return levels_ / count_; }

  Blob& operator+=(const Blob& other) {
    const Eigen::Vector2d shift = other.origin_ - origin_;
    squares_ += other.squares_ + shift * other.sum_.transpose() + other.sum_ * shift.transpose() +
                other.count_ * shift * shift.transpose();
    sum_ += other.sum_ + other.count_ * shift;
    levels_ += other.levels_;
    count_ += other.count_;
    return *this;
  }

  // The filled ellipse with these moments: its shape matrix is 4 times the covariance. Each pixel
  // is a square, which adds a variance of 1/12.
  [[nodiscard]] std::optional<ellipse::Ellipse> filled_ellipse() const {
    const Eigen::Vector2d mean = sum_ / count_;
    const Eigen::Matrix2d covariance =
        squares_ / count_ - mean * mean.transpose() + Eigen::Matrix2d::Identity() / 12.0;
    return ellipse::from_shape(origin_ + mean, 4.0 * covariance);
  }

 private:
  double count_ = 0.0;
  double levels_ = 0.0;
  Eigen::Vector2d origin_{0.0, 0.0};
  Eigen::Vector2d sum_{0.0, 0.0};
  Eigen::Matrix2d squares_ = Eigen::Matrix2d::Zero();
};

namespace {

using ellipse::Ellipse;

// Edge error of a segment: half a pixel each from sampling and blur.
constexpr double kEdge_px = 1.0;
// Number of thresholds to try; they are 16 levels apart, which is the minimum contrast.
constexpr unsigned kThresholds = 16;
constexpr double kLevels = 256.0;

// 1/2, 1/4, 3/4, 1/8, ... for 1, 2, 3, 4, ...: each value bisects the largest gap.
double bisection(unsigned index) {
  double value = 0.0;
  for (double digit = 0.5; index != 0; index /= 2, digit /= 2.0) value += digit * (index % 2);
  return value;
}

double area_of(const Ellipse& e) {
  return std::numbers::pi * e.semi_major * e.semi_minor;
}

// The paper's test of circularity: whether a segment fills its ellipse.
bool is_filled(const Blob& blob, const Ellipse& e) {
  return std::abs(blob.area() - area_of(e)) <= kEdge_px * perimeter_px(e);
}

// Inner radius of the pad's ring, relative to the painted circle.
double proportion(const ellipse::Pad& pad) {
  const auto inner = ellipse::inner_radius(pad);
  if (!inner) throw std::invalid_argument("whycon: the pad has no ring");
  return *inner;
}

// Half the width of tag36h11: 8 of the 10 cells of a square inscribed in the ring's inner circle.
double roundel_radius(const ellipse::Pad& pad) {
  return 0.5 * 0.8 * std::numbers::sqrt2 * proportion(pad);
}

}  // namespace

// The thresholded picture as connected black and white segments.
struct WhyCon::Segments {
  Segments(const ellipse::ImageView& picture, double threshold)
      : grey(picture.height,
             picture.width,
             CV_8UC1,
             const_cast<std::uint8_t*>(picture.data),  // cv::Mat has no read-only view
             static_cast<std::size_t>(picture.stride)) {
    const cv::Mat is_black = grey < threshold;
    blacks = cv::connectedComponentsWithStats(is_black, black, black_boxes, black_centroids, 4);
    cv::connectedComponentsWithStats(~is_black, white, white_boxes, white_centroids, 4);
  }

  [[nodiscard]] static cv::Rect box(const cv::Mat& boxes, int label) {
    const int* box = boxes.ptr<int>(label);
    return {box[cv::CC_STAT_LEFT],
            box[cv::CC_STAT_TOP],
            box[cv::CC_STAT_WIDTH],
            box[cv::CC_STAT_HEIGHT]};
  }

  [[nodiscard]] int white_at(const double* point) const {
    return white.at<int>(static_cast<int>(std::lround(point[1])),
                         static_cast<int>(std::lround(point[0])));
  }

  cv::Mat grey;
  cv::Mat black;  // labels; 0 = other colour
  cv::Mat white;
  cv::Mat black_boxes;
  cv::Mat black_centroids;
  cv::Mat white_boxes;
  cv::Mat white_centroids;
  int blacks = 0;
};

struct WhyCon::Ring {
  Blob black;
  Blob white;
  Blob both;
  Ellipse outer;  // of both segments
  Ellipse inner;  // of the white segment
};

WhyCon::WhyCon(const ellipse::Camera& camera, double inner_ratio, double radius)
    : camera_(camera), inner_ratio_(inner_ratio), radius_(radius) {}

void WhyCon::forget() {
  last_threshold_.reset();
  failures_ = 1;
}

double WhyCon::threshold() const {
  const unsigned step = failures_ % kThresholds;
  if (step != 0) return kLevels * bisection(step);
  return last_threshold_.value_or(kLevels * bisection(1));
}

std::optional<Sighting> WhyCon::find(const ellipse::ImageView& picture,
                                     const Eigen::Vector3d& gravity) {
  const std::optional<Ellipse> ring = find_ring(picture);
  if (!ring) return std::nullopt;
  const auto poses = ellipse::circle_poses(camera_, *ring);
  if (!poses) return std::nullopt;
  const auto& [one, other] = *poses;
  const bool is_first = one.normal.dot(gravity) <= other.normal.dot(gravity);
  return Sighting{radius_ * (is_first ? one : other).position, ring->semi_major};
}

std::optional<Ellipse> WhyCon::find_ring(const ellipse::ImageView& picture) {
  const Segments segments(picture, threshold());
  std::optional<Ring> best;
  for (int label = 1; label < segments.blacks; ++label) {
    const auto ring = ring_of(segments, label);
    if (ring && (!best || ring->outer.semi_major > best->outer.semi_major)) best = ring;
  }
  if (!best) {
    ++failures_;
    return std::nullopt;
  }
  failures_ = 0;
  last_threshold_ = 0.5 * (best->black.level() + best->white.level());
  return compensated(*best);
}

// Combines a black segment and the white one at its centre if they form a ring.
std::optional<WhyCon::Ring> WhyCon::ring_of(const Segments& segments, int black) const {
  const cv::Rect box = Segments::box(segments.black_boxes, black);
  // A ring thinner than its edge errors has no defined proportion.
  const double smallest = 2.0 * 2.0 * kEdge_px / (1.0 - inner_ratio_);
  const bool is_cut = box.x == 0 || box.y == 0 || box.br().x == segments.grey.cols ||
                      box.br().y == segments.grey.rows;
  if (is_cut || box.width < smallest || box.height < smallest) return std::nullopt;
  const int white = segments.white_at(segments.black_centroids.ptr<double>(black));
  if (white == 0) return std::nullopt;
  const cv::Rect white_box = Segments::box(segments.white_boxes, white);
  if ((white_box & box) != white_box) return std::nullopt;

  return measured(segments, box, black, white);
}

std::optional<WhyCon::Ring> WhyCon::measured(const Segments& segments,
                                             const cv::Rect& box,
                                             int black,
                                             int white) const {
  Ring ring;
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) {
      const double level = segments.grey.at<std::uint8_t>(y, x);
      if (segments.black.at<int>(y, x) == black) ring.black.add({x, y}, level);
      if (segments.white.at<int>(y, x) == white) ring.white.add({x, y}, level);
    }
  }
  ring.both = ring.black;
  ring.both += ring.white;
  const auto outer = ring.both.filled_ellipse();
  const auto inner = ring.white.filled_ellipse();
  if (!outer || !inner) return std::nullopt;
  ring.outer = *outer;
  ring.inner = *inner;
  return is_ring(ring) ? std::optional(ring) : std::nullopt;
}

bool WhyCon::is_ring(const Ring& ring) const {
  const Ellipse& outer = ring.outer;
  const Ellipse& inner = ring.inner;
  if (!is_filled(ring.both, outer) || !is_filled(ring.white, inner)) return false;
  const double share = inner_ratio_ * inner_ratio_;
  const double area_error = kEdge_px * (perimeter_px(inner) + share * perimeter_px(outer));
  if (std::abs(ring.white.area() - share * ring.both.area()) > area_error) return false;
  // To first order, perspective displaces the centre of a tilted circle's image from the image of
  // its centre by radius^2 sin(tilt) / focal length. Ellipses of concentric circles with different
  // radii are therefore not concentric.
  const double flatness = outer.semi_minor / outer.semi_major;
  const double perspective = (1.0 - share) * outer.semi_major * outer.semi_major / camera_.fx *
                             std::sqrt(1.0 - flatness * flatness);
  return (outer.center() - inner.center()).norm() <= kEdge_px + perspective;
}

// A threshold that is not midway between black and white shifts both edges of the ring by the same
// distance, in opposite directions. The known proportion then gives the true outer edge.
Ellipse WhyCon::compensated(const Ring& ring) const {
  Ellipse e = ring.outer;
  const double share = 1.0 + inner_ratio_;
  e.semi_major = (ring.outer.semi_major + ring.inner.semi_major) / share;
  e.semi_minor = (ring.outer.semi_minor + ring.inner.semi_minor) / share;
  return e;
}

ellipse::Sheet roundel_sheet(const ellipse::Pad& pad) {
  ellipse::Sheet sheet;
  sheet.shapes.push_back(
      ellipse::wild::disc({0.0, 0.0}, roundel_radius(pad), {.level = pad.paint_level}));
  sheet.shapes.back().hole = proportion(pad);
  return sheet;
}

std::unique_ptr<Peer> make_whycon(const ellipse::Camera& camera,
                                  const ellipse::Pad& pad,
                                  double radius) {
  return std::make_unique<WhyCon>(camera, proportion(pad), radius * roundel_radius(pad));
}

}  // namespace landing
