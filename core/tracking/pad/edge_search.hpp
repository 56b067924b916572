#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <bitset>
#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/homography.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {

/// An edge matched on a normal.
struct EdgeCandidate {
  float distance_px = 0.0F;  ///< Along the normal, from where it was expected.
  float contrast = 0.0F;     ///< [grey levels], above 0.
};

/// One sample of an edge of the pad, and what was matched around it.
struct EdgeSample {
  EdgeView view;
  float contrast = 0.0F;    ///< That it has on the pad [grey levels].
  int feature = 0;          ///< Number of the circle; or of the line, behind all circles.
  bool is_visible = false;  ///< Its normal is inside the picture.
  int count = 0;            ///< Of candidates.
  std::array<EdgeCandidate, 3> candidates;  ///< The strongest first.

  [[nodiscard]] double predicted_px(const HomographyChange& change) const {
    return view.row.dot(change);
  }
};

/// Looks for the edges of a pad along their normals, in a picture.
class EdgeSearch {
 public:
  /// Spreads samples over all edges inside the picture, evenly by their length there.
  void place(const PadModel& model, const PadView& view, const ImageView& luma, int samples);

  /// Looks at each sample for edges of the right sign.
  /// @param gain       Of the picture's contrast over the model's.
  /// @param reach_px   How far; where a covariance is given, three of its standard deviations and
  ///                   2 px at each sample, at least that and at most `max_px`.
  void look(const ImageView& luma,
            double gain,
            double reach_px,
            const HomographyCovariance* covariance = nullptr,
            double max_px = 0.0);

  [[nodiscard]] std::span<const EdgeSample> samples() const { return samples_; }
  /// Share of the outer circle inside the picture, of the last place().
  [[nodiscard]] double visible_fraction() const { return visible_fraction_; }

  static constexpr int kMaxSamples = 256;
  static constexpr std::size_t kCircleSteps = 128;  ///< By which a circle's visible part is told.

 private:
  static constexpr std::size_t kMaxCircles = 8;
  using VisibleSteps = std::bitset<kCircleSteps>;
  struct Placement;

  void place_on_circle(const Placement& placement,
                       const PadCircle& circle,
                       const VisibleSteps& visible,
                       int feature);
  void place_on_line(const Placement& placement, const PadLine& line, int feature);
  void add(const Eigen::Matrix3d& view,
           const Eigen::Vector2d& place,
           const Eigen::Vector2d& to_bright,
           double contrast,
           int feature);
  void distort(const LensView& lens);
  void look_along(const ImageView& luma, double gain, double reach_px, EdgeSample& sample) const;

  std::vector<EdgeSample> samples_;
  double visible_fraction_ = 0.0;
  double narrowest_ = 0.0;  // between neighbouring circles [radii of the outer one]
};

}  // namespace ellipse
