#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/scene/edge.hpp"
#include "core/scene/foreground.hpp"
#include "core/scene/ground.hpp"
#include "core/scene/lens_map.hpp"
#include "core/scene/pad.hpp"
#include "core/scene/scene.hpp"
#include "core/scene/sensor.hpp"
#include "core/scene/sheet_picture.hpp"

namespace ellipse {

/// Renders the frames of one scene. One object serves one thread at a time.
///
/// Through a lens, edges are within .01 px of where the lens puts them. What it does not show is
/// black, in whole blocks of 4 x 4 px. Its blur is of the picture's pixels.
class SceneRenderer {
 public:
  /// Throws std::invalid_argument where the ground's picture is no good, or the lens does not show
  /// the field of view.
  explicit SceneRenderer(const Scene& scene);

  /// The frame whose exposure has its middle at a time, with its truth at that middle.
  /// @param frame  Its number: the noise differs from frame to frame.
  /// Allocates only when frames grow. O(pixels), times the length of the motion's blur.
  Truth render(double time_s, std::uint64_t frame, const MutableImage& picture);

  /// One instant through any view, with sheets and bars where they are at time 0, and the truth of
  /// the pad alone. The lens, where there is
  /// one, is that of camera_of().
  Truth render(const View& view, std::uint64_t frame, const MutableImage& picture);

  /// The same, where the pad lies still on the ground, and without the glare.
  Truth render(const Eigen::Matrix3d& image_from_pad,
               std::uint64_t frame,
               const MutableImage& picture);

  [[nodiscard]] const Scene& scene() const { return scene_; }

  /// The lens of the last frame, where it distorts the picture; else nullptr. Until the next frame.
  [[nodiscard]] const Lens* bent_lens() const { return lens_map_ ? &lens_map_->lens() : nullptr; }

 private:
  struct Block;  // some pixels, and the piece of the plane that they see

  void start_frame(const MutableImage& picture);
  template <class Use>
  void for_each_patch(const Eigen::Matrix3d& plane_from_ideal, const Use& use) const;
  void add_exposure(double time_s);
  void finish_light(double time_s);
  void add_instant(const View& view,
                   const std::optional<SheetView>& rolling,
                   const std::vector<std::optional<SheetView>>& sheets,
                   float weight);
  void add_plane(const View& view, const std::optional<SheetView>& rolling, float weight);
  void paint(const SheetPicture& sheet, const SheetView& view);
  [[nodiscard]] std::optional<SheetView> rolling_at(double time_s) const;
  void look(const View& view, const Eigen::Matrix3d& plane_from_image);
  void add_blocks(const Patch& patch, float weight);
  void add_glare_of(const View& view);
  [[nodiscard]] Block block_at(const Patch& patch, int left, int top) const;
  void fill(Block& block);
  void fill_ground(Block& block) const;
  void add_pad(Block& block) const;
  void add_shadows(Block& block) const;
  [[nodiscard]] Eigen::Matrix3d view_at(double time_s) const;
  [[nodiscard]] int instants_at(double time_s) const;
  [[nodiscard]] double moved_px(const Eigen::Matrix3d& end_from_begin,
                                const Eigen::Vector2d& picture_px) const;

  Scene scene_;
  GroundTexture ground_;
  PadPicture pad_;
  SensorReader sensor_;
  Camera camera_;
  std::optional<LensMap> lens_map_;  // for camera_; none for a pinhole
  std::vector<Band> shadows_;        // in the present patch
  Eigen::Matrix3d plane_from_image_;
  double plane_area_ = 0.0;  // determinant of plane_from_image_
  Eigen::Matrix3d ground_from_image_;
  int width_ = 0;
  int height_ = 0;
  std::vector<float> light_;
  std::vector<SheetPicture> sheets_;
  std::vector<float> earlier_;  // light of the exposure's earlier instants
};

}  // namespace ellipse
