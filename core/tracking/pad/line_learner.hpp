#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/detection/arcs/arcs.hpp"
#include "core/edges/chains.hpp"
#include "core/edges/gradient_map.hpp"
#include "core/image/image_view.hpp"
#include "core/tracking/pad/pad_model.hpp"
#include "core/tracking/pad/pad_view.hpp"

namespace ellipse {

/// Learns the straight edges inside a pad's outer circle: what its pattern, a cross or a letter, is
/// made of. The pad is seen from above, its edges are traced, and cut into straight parts.
class LineLearner {
 public:
  /// Allocates all that take() and learn() need, once.
  void reserve(PadModel& model);

  /// Begins a new picture of the pad from above.
  void start() { rows_ = 0; }
  /// Adds the next rows of that picture, an eighth of it, so that no frame pays for all. The frames
  /// may differ: each shows the pad where its view says. Allocates nothing after reserve().
  /// @param view  Exact to about a pixel.
  void take(const ImageView& luma, const PadView& view);
  /// Whether the picture is whole.
  [[nodiscard]] bool is_ready() const { return rows_ == kSize; }

  /// From a whole picture.
  /// @param model  Its circles tell what is no line, and what contrast to expect; its lines are
  ///               replaced. At most kMaxLines, the longest.
  /// Allocates nothing after reserve().
  void learn(PadModel& model);

  static constexpr std::size_t kMaxLines = 24;

 private:
  static constexpr int kSize = 208;              // of the pad from above [px]
  static constexpr double kPixel = 2.0 / kSize;  // [radii]

  void forget_maxima_at_border();
  void split(std::span<const std::int32_t> pixels, const PadModel& model);
  [[nodiscard]] PadLine line_through(std::span<const std::int32_t> pixels,
                                     const Eigen::Vector2d& from,
                                     const Eigen::Vector2d& to) const;
  void add(std::span<const std::int32_t> pixels, const PadModel& model);
  void keep_longest();
  [[nodiscard]] static Eigen::Vector2d place_of(int column, int row);
  [[nodiscard]] Eigen::Vector2d place_of(std::int32_t pixel) const;

  std::vector<std::uint8_t> pixels_;  // the pad from above
  int rows_ = 0;                      // that are there
  GradientMap map_;
  ChainTracer chains_;
  std::vector<PadLine> lines_;
};

}  // namespace ellipse
