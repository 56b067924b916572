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
/// With a lens, edges are within .01 px of their exact positions. Pixels outside the lens's range
/// are black, in whole blocks of 4 x 4 px. Blur is constant in pixels of the picture.
class SceneRenderer {
 public:
  /// Throws std::invalid_argument if the ground's picture is invalid or the lens does not cover the
  /// field of view.
  explicit SceneRenderer(const Scene& scene);

  /// Renders the frame with its exposure centred at a time; returns the truth at that time.
  /// @param frame  Its number: seeds the noise.
  /// Without sheets, and with progressive readout, allocates only when frames grow. O(pixels) times
  /// the length of the motion blur.
  Truth render(double time_s, std::uint64_t frame, const MutableImage& picture);

  /// Renders one instant in any view, with sheets and bars at time 0; returns the truth of the pad
  /// alone. Uses the lens of camera_of(), if any.
  Truth render(const View& view, std::uint64_t frame, const MutableImage& picture);

  /// The same, with the pad fixed on the ground and without glare.
  Truth render(const Eigen::Matrix3d& image_from_pad,
               std::uint64_t frame,
               const MutableImage& picture);

  [[nodiscard]] const Scene& scene() const { return scene_; }

  /// The lens of the last frame, or nullptr without distortion. Valid until the next frame.
  [[nodiscard]] const Lens* distorting_lens() const {
    return lens_map_ ? &lens_map_->lens() : nullptr;
  }

 private:
  struct Block;  // some pixels and their footprint on the plane

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
  std::vector<Band> shadows_;        // in the current patch
  Eigen::Matrix3d plane_from_image_;
  double plane_area_ = 0.0;  // determinant of plane_from_image_
  Eigen::Matrix3d ground_from_image_;
  int width_ = 0;
  int height_ = 0;
  std::vector<float> light_;
  std::vector<SheetPicture> sheets_;
  std::vector<float> earlier_;  // light of earlier instants of the exposure
};

}  // namespace ellipse
