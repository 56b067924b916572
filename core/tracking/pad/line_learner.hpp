#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/edges/chains.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/edges/subpixel.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {

/// Learns the straight edges of the pattern inside a pad's outer circle, such as a cross or a
/// letter: rectifies the pad to a top view, traces its edges and splits them into line segments.
class LineLearner {
 public:
  /// Allocates the buffers of take() and learn(), once.
  void reserve(PadModel& model);

  /// Starts a new top view.
  void start() { rows_ = 0; }
  /// Adds the next eighth of the top view's rows, which spreads the cost over frames. Allocates
  /// nothing after reserve().
  /// @param view  The pad's view in this frame, accurate to about a pixel.
  void take(const ImageView& luma, const PadView& view);
  /// Whether the top view is complete.
  [[nodiscard]] bool is_ready() const { return rows_ == kSize; }

  /// Learns the lines from a complete top view.
  /// @param model  Its circles exclude circular edges and give the expected contrast. Its lines are
  ///               replaced by the longest, at most kMaxLines.
  /// @param gain   Ratio of the contrast in the top view to the model's.
  /// Allocates nothing after reserve().
  void learn(PadModel& model, double gain);

  static constexpr std::size_t kMaxLines = 24;

 private:
  static constexpr int kSize = 208;              // of the top view [px]
  static constexpr double kPixel = 2.0 / kSize;  // [radii]

  void clear_maxima_at_border();
  void split(std::span<const std::int32_t> pixels, const PadModel& model);
  [[nodiscard]] PadLine line_through(std::span<const std::int32_t> pixels,
                                     const Eigen::Vector2d& from,
                                     const Eigen::Vector2d& to) const;
  void add(std::span<const std::int32_t> pixels, const PadModel& model);
  [[nodiscard]] static double min_contrast(const PadModel& model);
  [[nodiscard]] static Eigen::Vector2d pad_point_of(int column, int row);
  [[nodiscard]] Eigen::Vector2d pad_point_of(std::int32_t pixel) const;

  std::vector<std::uint8_t> pixels_;  // top view
  int rows_ = 0;                      // completed
  GradientMap map_;
  ChainTracer chains_;
  std::vector<PadLine> lines_;
  double gain_ = 1.0;  // of learn()
};

}  // namespace ellipse
