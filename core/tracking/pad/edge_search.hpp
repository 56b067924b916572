#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <bitset>
#include <span>
#include <vector>

#include "core/edges/outline_samples.hpp"
#include "core/geometry/homography.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {

/// An edge found along a sample's normal. Its relative contrast is contrast over light.
struct EdgeCandidate {
  float distance_px = 0.0F;  ///< Along the normal, from the expected position.
  float contrast = 0.0F;     ///< [grey levels], above 0.
  float light = 0.0F;        ///< Brightest level on its bright side, in the search range.
};

/// A sample on an edge of the pad, and the edges found near it.
struct EdgeSample {
  EdgeView view;
  float contrast = 0.0F;    ///< In the model [grey levels].
  int feature = 0;          ///< Index of the circle; or of the line, after all circles.
  bool is_visible = false;  ///< At least one box to each side of the edge is inside the image.
  int count = 0;            ///< Number of candidates.
  std::array<EdgeCandidate, 3> candidates;  ///< The strongest first.

  [[nodiscard]] double predicted_px(const HomographyChange& change) const {
    return view.row.dot(change);
  }
};

/// Light and pixel noise of an image.
struct ImageLevels {
  double gain = 1.0;   ///< Ratio of image contrast to model contrast.
  double noise = 0.0;  ///< Standard deviation of a pixel [grey levels], see pixel_noise().
  /// Ratio of relative contrast, see EdgeCandidate, to model contrast [1 / grey level]. 0 =
  /// unknown: no edge in shadow is accepted.
  double relative_gain = 0.0;
};

/// Searches an image for the edges of a pad along their normals.
///
/// One object serves one thread. Deterministic. Allocates at the first sample().
class EdgeSearch {
 public:
  /// Places kSamples on all visible edges, evenly by their length in the image.
  void sample(const PadModel& model, const PadView& view, const ImageView& luma);

  /// Searches edges of the expected polarity at each sample.
  /// @param reach_px   Search range. With a covariance: 3 sigma at each sample, within
  ///                   [reach_px, max_px].
  void search(const ImageView& luma,
              const ImageLevels& levels,
              double reach_px,
              const HomographyCovariance* covariance = nullptr,
              double max_px = 0.0);

  [[nodiscard]] std::span<const EdgeSample> samples() const { return samples_; }
  /// Visible share of the outer circle at the last sample().
  [[nodiscard]] double visible_fraction() const { return visible_fraction_; }

  static constexpr int kSamples = 96;               ///< Of a search.
  static constexpr int kMaxSamples = 2 * kSamples;  ///< Capacity: each edge rounds up.

 private:
  using VisibleSteps = std::bitset<OutlineSamples::kMaxSamples>;
  struct Placement;

  void sample_circle(const Placement& placement,
                     const PadCircle& circle,
                     const VisibleSteps& visible,
                     int feature);
  void sample_line(const Placement& placement, const PadLine& line, int feature);
  void add(const Eigen::Matrix3d& view,
           const Eigen::Vector2d& pad_point,
           const Eigen::Vector2d& to_bright,
           double contrast,
           int feature);
  void distort(const LensView& lens);
  void search_along(const ImageView& luma,
                    const ImageLevels& levels,
                    double reach_px,
                    EdgeSample& sample) const;

  std::vector<EdgeSample> samples_;
  double visible_fraction_ = 0.0;
  double narrowest_ = 0.0;  // min gap between neighbouring circles [radii of the outer one]
};

}  // namespace ellipse
