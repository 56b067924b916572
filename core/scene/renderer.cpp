// SPDX-License-Identifier: MIT
#include "core/scene/renderer.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/foreground.hpp"
#include "core/scene/random.hpp"
#include "core/scene/true_ellipses.hpp"

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kBlock = 8;            // pixels
constexpr float kSkyLevel = 200.0F;  // above the horizon
constexpr double kAllOfIt = 0.999;   // share from which a layer hides all beneath
// Largest spacing of instants at which blurred edges add up to an even ramp: within .1 % at 1.6
// standard deviations (the second term of the Gaussian's Fourier series).
constexpr double kInstantSpacing = 1.6;
// The mipmap is isotropic: pixels of a tilted plane need a slightly coarser level.
constexpr double kCoarser = 1.2;
// Rows of the plane rendered with one view under a rolling shutter: at 40 px a frame the error is
// below .06 px.
constexpr int kRollingRows = 2;

}  // namespace

struct SceneRenderer::Block {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
  int size = 0;  // of uncut blocks
  Vector2d middle_px{0.0, 0.0};
  double half_px = 0.0;  // from its middle to its corners
  bool is_in_front = true;
  Vector2d middle{0.0, 0.0};  // on the plane
  double half = 0.0;          // from there to its farthest corner
  std::array<float, std::size_t{kBlock} * kBlock> light{};

  [[nodiscard]] float& at(int x, int y) {
    return light[static_cast<std::size_t>(y) * kBlock + static_cast<std::size_t>(x)];
  }

  template <class Use>
  void for_each_pixel(const Use& use) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) use(Vector2d(left + x, top + y), at(x, y));
    }
  }
};

SceneRenderer::SceneRenderer(const Scene& scene)
    : scene_(scene),
      ground_(scene.ground, scene.seed),
      pad_(scene.pad, scene.sensor.blur_px, scene.seed),
      sensor_(scene.sensor),
      camera_(camera_of(scene, 0, 0)) {
  for (const Sheet& sheet : scene.sheets) sheets_.emplace_back(sheet, scene.sensor.blur_px);
}

Truth SceneRenderer::render(double time_s, std::uint64_t frame, const MutableImage& picture) {
  start_frame(picture);
  const double half_s = 0.5 * scene_.sensor.field_s;
  if (half_s == 0.0) {
    add_exposure(time_s);
  } else {
    add_exposure(time_s + half_s);
    const std::vector<float> odd = light_;
    std::fill(light_.begin(), light_.end(), 0.0F);
    add_exposure(time_s - half_s);
    for (int y = 1; y < height_; y += 2) {
      const auto row = static_cast<std::ptrdiff_t>(y) * width_;
      std::copy_n(odd.begin() + row, width_, light_.begin() + row);
    }
  }
  finish_light(time_s);
  sensor_.read(light_, hash(scene_.seed ^ hash(frame)), picture);
  const bool is_plain = scene_.sheets.empty() && half_s == 0.0 && scene_.sensor.readout_s == 0.0;
  if (is_plain) return truth_of(scene_.pad, view_at(time_s), camera_);
  return target_of(true_ellipses(scene_, time_s, width_, height_));
}

// Adds the light of a frame's exposure around a time.
void SceneRenderer::add_exposure(double time_s) {
  const int instants = instants_at(time_s);
  const float weight = 1.0F / static_cast<float>(instants);
  for (int i = 0; i < instants; ++i) {
    const double part = (i + 0.5) / instants - 0.5;
    const double instant_s = time_s + part * scene_.sensor.exposure_s;
    std::vector<std::optional<SheetView>> sheets;
    for (const SheetPicture& sheet : sheets_) {
      sheets.push_back(view_of(sheet.sheet(), scene_, camera_, instant_s));
    }
    add_instant({.image_from_pad = view_at(instant_s)}, rolling_at(instant_s), sheets, weight);
  }
  add_glare_of(
      {.image_from_pad = view_at(time_s), .camera = pose_at(scene_.flight, time_s).position});
}

void SceneRenderer::finish_light(double time_s) {
  const LightImage light{light_, width_, height_};
  add_gradient(scene_.light.gradient, light);
  add_vignette(scene_.light.vignette, light);
  add_bars(scene_, time_s, light);
}

Truth SceneRenderer::render(const View& view, std::uint64_t frame, const MutableImage& picture) {
  start_frame(picture);
  std::vector<std::optional<SheetView>> sheets;
  for (const SheetPicture& sheet : sheets_) {
    const auto image = image_from_sheet(sheet.sheet(), view.image_from_pad, camera_, 0.0);
    sheets.push_back(image ? std::optional(SheetView{image->inverse()}) : std::nullopt);
  }
  add_instant(view, {}, sheets, 1.0F);
  add_glare_of(view);
  finish_light(0.0);
  sensor_.read(light_, hash(scene_.seed ^ hash(frame)), picture);
  return truth_of(scene_.pad, view.image_from_pad, camera_);
}

Truth SceneRenderer::render(const Matrix3d& image_from_pad,
                            std::uint64_t frame,
                            const MutableImage& picture) {
  return render(View{.image_from_pad = image_from_pad}, frame, picture);
}

void SceneRenderer::start_frame(const MutableImage& picture) {
  width_ = picture.width;
  height_ = picture.height;
  light_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0F);
  if (camera_.width == width_ && camera_.height == height_) return;
  camera_ = camera_of(scene_, width_, height_);
  if (camera_.is_distorted()) lens_map_.emplace(camera_);
}

Matrix3d SceneRenderer::view_at(double time_s) const {
  return image_from_pad(pose_at(scene_.flight, time_s), camera_);
}

// The row-dependent view of the plane under a rolling shutter; nullopt without one.
std::optional<SheetView> SceneRenderer::rolling_at(double time_s) const {
  if (scene_.sensor.readout_s == 0.0) return std::nullopt;
  return view_of(Sheet{}, scene_, camera_, time_s);
}

// Displacement of a point of the picture; 0 if the lens does not map it.
double SceneRenderer::moved_px(const Matrix3d& end_from_begin, const Vector2d& picture_px) const {
  const auto moved = [&](const Vector2d& p) {
    return Vector2d((end_from_begin * p.homogeneous()).hnormalized());
  };
  if (!lens_map_) return (moved(picture_px) - picture_px).norm();
  const auto ideal = lens_map_->lens().ideal_from_picture(picture_px);
  const auto end = ideal ? lens_map_->lens().picture_from_ideal(moved(*ideal)) : std::nullopt;
  return end ? (end->picture_px - picture_px).norm() : 0.0;
}

// Number for the fastest corner of the picture. With a lens, which may not map the corners, the
// middle and the sides count too.
int SceneRenderer::instants_at(double time_s) const {
  const double exposure_s = scene_.sensor.exposure_s;
  if (!(exposure_s > 0.0)) return 1;
  const auto view = [&](double part) { return view_at(time_s + part * exposure_s); };
  const Matrix3d end_from_begin = view(0.5) * view(-0.5).inverse();
  double farthest_px = 0.0;
  for (const double x : {0.0, 0.5, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      if (!lens_map_ && (x == 0.5 || y == 0.5)) continue;
      const Vector2d pixel(x * (width_ - 1), y * (height_ - 1));
      farthest_px = std::max(farthest_px, moved_px(end_from_begin, pixel));
    }
  }
  const double spacing_px = kInstantSpacing * scene_.sensor.blur_px;
  return static_cast<int>(std::clamp(std::ceil(farthest_px / spacing_px), 1.0, 1e6));
}

// With a lens, each patch has its own homography; without one the picture is one patch.
template <class Use>
void SceneRenderer::for_each_patch(const Matrix3d& plane_from_ideal, const Use& use) const {
  if (!lens_map_) return use(Patch{0, 0, width_, height_, plane_from_ideal});
  constexpr int kSize = LensMap::kBlock;
  for (int top = 0; top < height_; top += kSize) {
    for (int left = 0; left < width_; left += kSize) {
      const int column = left / kSize;
      const int row = top / kSize;
      if (!lens_map_->is_shown(column, row)) continue;
      use(Patch{left,
                top,
                std::min(kSize, width_ - left),
                std::min(kSize, height_ - top),
                plane_from_ideal * lens_map_->ideal_from_picture(column, row)});
    }
  }
}

void SceneRenderer::add_instant(const View& view,
                                const std::optional<SheetView>& rolling,
                                const std::vector<std::optional<SheetView>>& sheets,
                                float weight) {
  if (sheets.empty()) return add_plane(view, rolling, weight);
  std::swap(light_, earlier_);
  light_.assign(earlier_.size(), 0.0F);
  add_plane(view, rolling, 1.0F);
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    if (sheets[i]) paint(sheets_[i], *sheets[i]);
  }
  for (std::size_t i = 0; i < light_.size(); ++i) light_[i] = earlier_[i] + weight * light_[i];
}

void SceneRenderer::add_plane(const View& view,
                              const std::optional<SheetView>& rolling,
                              float weight) {
  const auto add = [&](const Patch& patch) {
    look(view, patch.plane_from_image);
    add_blocks(patch, weight);
  };
  if (!rolling || lens_map_) return for_each_patch(view.image_from_pad.inverse(), add);
  for (int top = 0; top < height_; top += kRollingRows) {
    const int rows = std::min(kRollingRows, height_ - top);
    add({0, top, width_, rows, rolling->at_row(top + 0.5 * (rows - 1))});
  }
}

void SceneRenderer::paint(const SheetPicture& sheet, const SheetView& view) {
  const LightImage light{light_, width_, height_};
  if (!lens_map_) return sheet.paint(view, {0, 0, width_, height_, Matrix3d::Identity()}, light);
  for_each_patch(Matrix3d::Identity(), [&](const Patch& patch) {
    const double row = patch.top + 0.5 * (patch.height - 1);
    sheet.paint({view.at_row(row) * patch.plane_from_image}, patch, light);
  });
}

void SceneRenderer::add_glare_of(const View& view) {
  if (!(scene_.light.glare.level > 0.0) || !view.camera) return;
  for_each_patch(view.image_from_pad.inverse(), [&](const Patch& patch) {
    add_glare(scene_.light.glare, *view.camera, patch, {light_, width_, height_});
  });
}

void SceneRenderer::look(const View& view, const Matrix3d& plane_from_image) {
  plane_from_image_ = plane_from_image;
  ground_from_image_ = view.ground_from_pad.matrix() * plane_from_image_;
  plane_area_ = std::abs(plane_from_image_.determinant());
  pad_.look(plane_from_image_);
  shadows_.clear();
  for (const Shadow& shadow : scene_.light.shadows) {
    const Vector2d normal(std::cos(shadow.direction_rad), std::sin(shadow.direction_rad));
    shadows_.push_back(project_band(plane_from_image_, normal, shadow.center, shadow.half_width));
  }
}

void SceneRenderer::add_blocks(const Patch& patch, float weight) {
  for (int top = patch.top; top < patch.top + patch.height; top += kBlock) {
    for (int left = patch.left; left < patch.left + patch.width; left += kBlock) {
      Block block = block_at(patch, left, top);
      fill(block);
      for (int y = 0; y < block.height; ++y) {
        float* row =
            &light_[static_cast<std::size_t>(block.top + y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(block.left)];
        for (int x = 0; x < block.width; ++x) row[x] += weight * block.at(x, y);
      }
    }
  }
}

SceneRenderer::Block SceneRenderer::block_at(const Patch& patch, int left, int top) const {
  Block block;
  block.left = left;
  block.top = top;
  block.width = std::min(kBlock, patch.left + patch.width - left);
  block.height = std::min(kBlock, patch.top + patch.height - top);
  block.size = lens_map_ ? LensMap::kBlock : kBlock;
  const Vector2d first(left, top);
  const Vector2d half_size(0.5 * (block.width - 1), 0.5 * (block.height - 1));
  block.middle_px = first + half_size;
  block.half_px = half_size.norm() + 0.5;
  const Vector3d middle = plane_from_image_ * block.middle_px.homogeneous();
  block.is_in_front = middle.z() > 0.0;
  if (!block.is_in_front) return block;
  block.middle = middle.hnormalized();
  for (const double sx : {-0.5, 0.5}) {
    for (const double sy : {-0.5, 0.5}) {
      const Vector2d corner = block.middle_px + Vector2d(sx * block.size, sy * block.size);
      const Vector3d q = plane_from_image_ * corner.homogeneous();
      block.is_in_front = block.is_in_front && q.z() > 0.0;
      if (block.is_in_front) {
        block.half = std::max(block.half, (q.hnormalized() - block.middle).norm());
      }
    }
  }
  return block;
}

void SceneRenderer::fill(Block& block) {
  const Pad& pad = scene_.pad;
  if (block.is_in_front &&
      pad_.is_uniform(block.middle_px, block.half_px, block.middle, block.half)) {
    const PadPicture::Layers layers = pad_.at(block.middle_px);
    if (layers.paint > kAllOfIt) {
      block.light.fill(static_cast<float>(pad.paint_level));
    } else if (layers.plate > kAllOfIt) {
      block.light.fill(static_cast<float>(pad.plate_level));
    } else if (layers.rim > kAllOfIt) {
      block.light.fill(static_cast<float>(pad.rim_level));
    } else {
      fill_ground(block);
    }
  } else {
    fill_ground(block);
    add_pad(block);
  }
  if (!shadows_.empty()) add_shadows(block);
}

void SceneRenderer::fill_ground(Block& block) const {
  if (block.is_in_front && ground_.is_plain()) {
    block.light.fill(static_cast<float>(ground_.mean()));
    return;
  }
  const double wider = kCoarser * std::max(1.0, kCoarser * scene_.sensor.blur_px);
  const auto coarseness = [&](double depth) {
    return GroundTexture::coarseness(wider * std::sqrt(plane_area_ / (depth * depth * depth)));
  };
  const Vector3d step = ground_from_image_.col(0);
  const int steps = block.size;
  for (int y = 0; y < block.height; ++y) {
    Vector3d q = ground_from_image_ * Vector3d(block.left, block.top + y, 1.0);
    const double last_depth = q.z() + steps * step.z();
    const bool is_in_front = q.z() > 0.0 && last_depth > 0.0;
    const float first = is_in_front ? coarseness(q.z()) : 0.0F;
    const float change =
        is_in_front ? (coarseness(last_depth) - first) / static_cast<float>(steps) : 0.0F;
    for (int x = 0; x < block.width; ++x, q += step) {
      float& light = block.at(x, y);
      if (!(q.z() > 0.0)) {
        light = kSkyLevel;
      } else if (ground_.is_plain() || !is_in_front) {
        light = static_cast<float>(ground_.mean());
      } else {
        const auto px = static_cast<float>(q.x() / q.z());
        const auto py = static_cast<float>(q.y() / q.z());
        light = ground_.at(px, py, first + change * static_cast<float>(x));
      }
    }
  }
}

void SceneRenderer::add_pad(Block& block) const {
  const Pad& pad = scene_.pad;
  block.for_each_pixel([&](const Vector2d& pixel, float& light) {
    const bool is_visible =
        block.is_in_front || plane_from_image_.row(2).dot(pixel.homogeneous()) > 0.0;
    if (!is_visible) return;
    const PadPicture::Layers layers = pad_.at(pixel);
    double mixed = light;
    mixed += layers.rim * (pad.rim_level - mixed);
    mixed += layers.plate * (pad.plate_level - pad.rim_level);
    mixed += layers.paint * (pad.paint_level - mixed);
    light = static_cast<float>(mixed);
  });
}

void SceneRenderer::add_shadows(Block& block) const {
  for (std::size_t i = 0; i < shadows_.size(); ++i) {
    const Shadow& shadow = scene_.light.shadows[i];
    // The penumbra in pixels, by the block's own scale.
    const double px_per_radius = block.half > 0.0 ? block.half_px / block.half : 0.0;
    const double blur_px = std::hypot(scene_.sensor.blur_px, shadow.penumbra * px_per_radius);
    const auto lit = [&](const Vector2d& pixel) {
      return static_cast<float>(1.0 - shadow.depth * shadows_[i].coverage(pixel, blur_px));
    };
    if (shadows_[i].is_clear_of(block.middle_px, block.half_px + kStepReach * blur_px)) {
      const float share = lit(block.middle_px);
      for (float& light : block.light) light *= share;
    } else {
      block.for_each_pixel([&](const Vector2d& pixel, float& light) { light *= lit(pixel); });
    }
  }
}

}  // namespace ellipse
