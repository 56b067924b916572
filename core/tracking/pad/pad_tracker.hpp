#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/camera/camera.hpp"
#include "core/camera/circle_pose.hpp"
#include "core/camera/lens_view.hpp"
#include "core/camera/picture.hpp"
#include "core/geometry/homography.hpp"
#include "core/tracking/pad/edge_search.hpp"
#include "core/tracking/pad/homography_filter.hpp"
#include "core/tracking/pad/homography_solver.hpp"
#include "core/tracking/pad/line_learner.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/refined_edges.hpp"

namespace ellipse {

/// A frame, or the part of it that is searched.
struct PadFrame {
  Picture picture;                     ///< Its lens must outlive the tracker.
  Eigen::Vector2d frame_px{0.0, 0.0};  ///< Width and height of the whole frame.
  std::optional<Camera> camera{};      ///< If known.
};

/// Tracking result of one frame.
struct PadTrack {
  Ellipse ellipse;              ///< The outer circle [px of the frame's ideal plane].
  double coverage = 0.0;        ///< Matched share of the pad's visible edges.
  double outer_coverage = 0.0;  ///< The same of its outer edge alone.
  bool is_visible = false;      ///< The matches determine the centre; else it is predicted.
};

/// Tracks a pad by its edges: predicts its view, searches each edge along its normal, and solves
/// for the change of the view that explains the matches best, given a motion prior.
///
/// Searches near the prediction; if that fails, as far as an unknown motion may have moved the pad.
/// One object tracks one pad, on one thread. Deterministic. Allocates only in lock().
class PadTracker {
 public:
  /// Learns a pad from its outer edge.
  /// @return Whether the learned edges match the image.
  [[nodiscard]] bool lock(const PadFrame& frame, const Ellipse& outer_edge);

  /// Continues with the pad that was locked last where the detector found one of its circles. While
  /// locked, the distance from the last match gives its velocity.
  /// @return nullopt if no pad is known, the last call of track() matched it, or its edges do not
  ///         match the image.
  [[nodiscard]] std::optional<PadTrack> resume(const PadFrame& frame, const Ellipse& edge);

  /// @param elapsed_s  Since the last call.
  /// @return nullopt if the pad is lost.
  [[nodiscard]] std::optional<PadTrack> track(const PadFrame& frame, double elapsed_s);

  /// @param refinement  Of the outer edge in each frame; it corrects the view.
  /// @param ring_ratio  Inner over outer radius of the pad's ring, for the next lock; 0 = learned.
  void configure(Refinement refinement, double ring_ratio) {
    edges_.configure(refinement);
    ring_ratio_ = ring_ratio;
  }

  [[nodiscard]] bool is_locked() const { return is_locked_; }
  /// The outer circle in the last frame, as in PadTrack. nullopt if it is not an ellipse.
  [[nodiscard]] std::optional<Ellipse> outline() const { return project_circle(view_, 1.0); }

  /// Whether circles inside the outer one are known.
  [[nodiscard]] bool has_inner_edges() const { return model_.circles.size() > 1; }

  /// Uncertainty of the outer edge in the last frame: from its refinement; of a short arc, or
  /// without a refinement, from all edges and the motion.
  [[nodiscard]] RingUncertainty uncertainty() const;
  /// Inner circles as measured in the last frame [px of its ideal plane]. Empty without a camera or
  /// a measurement. Valid until the next call.
  [[nodiscard]] std::span<const FittedEllipse> inner_edges() const { return edges_.inner(); }
  /// The view by the lines of the pad's pattern; nullopt without lines.
  [[nodiscard]] std::optional<PatternView> pattern() const;
  /// Ends tracking. The pad stays known to resume().
  void release() { is_locked_ = false; }
  /// Ends tracking and forgets the pad.
  void forget() { is_locked_ = is_known_ = false; }

  /// Region of the next frame to pass to track() [px]; covers its search range.
  /// @param elapsed_s  Until the next frame.
  [[nodiscard]] Rect region_after(double elapsed_s, int width, int height) const;

 private:
  struct Attempt {
    Eigen::Matrix3d view;
    HomographyEstimate estimate;  // total change from the prediction
    HomographyChange last;        // change since the samples were placed
    HomographySupport support;
    double visible = 0.0;
  };

  void begin_frame(const PadFrame& frame);
  [[nodiscard]] HomographyFilter predicted(double elapsed_s, double noise_factor) const;
  [[nodiscard]] std::optional<Attempt> search_from(const Picture& picture,
                                                   const Eigen::Matrix3d& start,
                                                   const HomographyCovariance& covariance);
  [[nodiscard]] static bool is_good(const std::optional<Attempt>& attempt);
  [[nodiscard]] Attempt attempt_of(const Eigen::Matrix3d& view,
                                   const HomographyEstimate& estimate,
                                   const HomographyChange& last) const;
  [[nodiscard]] bool is_possible(const Eigen::Matrix3d& view) const;
  void accept(const Attempt& attempt,
              const HomographyFilter& before,
              double noise_factor,
              double adaptation);
  [[nodiscard]] Eigen::Vector2d motion_to(const Eigen::Matrix3d& view) const;
  void propagate_errors(const Attempt& attempt, const HomographyCovariance& prior_information);
  [[nodiscard]] HomographyCovariance covariance() const;
  [[nodiscard]] HomographyCovariance detected_covariance() const;
  [[nodiscard]] static bool has_circle(const Eigen::Matrix3d& view,
                                       double radius,
                                       const Ellipse& detected);
  void begin_motion(const Attempt& attempt, const HomographyChange& velocity);
  void measure_edges(const Picture& picture, double visible, double adaptation);
  void refine(const Picture& picture, double visible, double adaptation);
  void correct_view(const Eigen::Matrix3d& refined, const RingMatrix& errors);
  void learn_lines(const Picture& picture, const Attempt& attempt);
  void coast(const Eigen::Matrix3d& prediction, const HomographyFilter& before, double elapsed_s);
  [[nodiscard]] std::optional<PadTrack> make_track(const Attempt* attempt) const;
  [[nodiscard]] double radius_px() const;

  std::optional<RingUncertainty> refined_;  // of the outer edge, if refined in the last frame
  double ring_ratio_ = 0.0;
  PadModel model_;
  EdgeSearch search_;
  LineLearner line_learner_;
  RefinedEdges edges_;
  double learned_radius_px_ = 0.0;  // of the pad when its lines were learned last
  Eigen::Matrix3d view_ = Eigen::Matrix3d::Identity();          // frame from pad
  Eigen::Matrix3d matched_view_ = Eigen::Matrix3d::Identity();  // of the last match
  HomographyFilter motion_;
  Camera camera_;  // of the last frame; assumed if unknown
  bool is_camera_known_ = false;
  LensView lens_;
  double noise_factor_ = 1.0;   // adaptive factor of the motion noise
  double gain_ = 1.0;           // ratio of image contrast to model contrast
  double relative_gain_ = 0.0;  // the same of relative contrast [1 / grey level]
  double elapsed_s_ = 0.0;      // before the last frame of track()
  double unmatched_s_ = 0.0;    // since the last match
  double last_coverage_ = 0.0;  // of the search near the prediction
  bool is_locked_ = false;
  bool is_known_ = false;  // the model is that of a pad that was locked
};

}  // namespace ellipse
