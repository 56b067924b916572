#pragma once  // SPDX-License-Identifier: MIT

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "core/scene/random.hpp"
#include "core/scene/wild.hpp"
#include "core/scene/wild_shapes.hpp"

namespace ellipse::wild {

/// Azimuth from which the horizon is level [rad].
inline constexpr double kFacing = -0.5 * std::numbers::pi;

/// Two grey levels of the picture.
struct Greys {
  double paint = 0.0;
  double around = 0.0;
};

/// Builder of a wild scene.
class Draft {
 public:
  /// Sets the camera: format, sensor, field of view.
  Draft(std::uint64_t seed, WildTheme theme);

  Wild wild;
  Random random;

  [[nodiscard]] Scene& scene() { return wild.scene; }
  [[nodiscard]] bool chance(double probability) { return random.unit() < probability; }
  /// In [low, high), log-uniform.
  [[nodiscard]] double log_between(double low, double high) {
    return low * std::pow(high / low, random.unit());
  }
  [[nodiscard]] std::uint64_t seed() {
    return hash(static_cast<std::uint64_t>(random.unit() * 1e15));
  }
  [[nodiscard]] double sign() { return chance(0.5) ? 1.0 : -1.0; }
  void note(std::string_view thing);

  /// The light that gives a grey level in the picture, without vignette.
  [[nodiscard]] double light(double grey) const;
  [[nodiscard]] Paint paint(double grey, double texture_greys = 0.0, double grain = 8.0) const;
  /// Two levels with a random contrast of at least 8 grey levels; bright on dark or reverse.
  [[nodiscard]] Greys greys();

  [[nodiscard]] double focal_px() const;
  /// Puts a plane under the camera.
  /// @param contrast  Of its texture; 1 = about 20 grey levels.
  void ground(GroundKind kind, double grey, double contrast);
  /// Points the camera at the world's origin, at a scale of `unit_px` per unit there; the origin is
  /// anywhere in the picture's middle part.
  /// @param off_middle  0 = exactly in the middle, 1 = up to the picture's border.
  void look(double unit_px, double tilt_rad, double azimuth_rad, double off_middle = 0.7);

  Sheet& sheet(const Eigen::Matrix3d& frame);
  Sheet& picture_sheet();  ///< A new sheet in the picture's frame [widths].

  // Content for any scene.
  void limb();     ///< A hand, an arm or a leg that reaches into the picture.
  void netting();  ///< A mesh, a net or a fence in front of the camera.
  void cable();    ///< Thin lines across.
  void shadow();   ///< A shadow with straight or uneven edges on the ground.
  void weather();  ///< Uneven light.
  void people(double distance, double height, double azimuth_rad);
  void boxes(int count, double reach, double size);  ///< Lying around on the ground.

  /// Random defocus at which shapes of this semi-minor axis stay visible.
  void defocus(double semi_minor_px);

 private:
  void choose_format();
  void choose_sensor();
  void choose_shutter();

  double contrast_ = 100.0;
};

// The themes.
void make_pads(Draft& draft);
void make_eye(Draft& draft, bool is_closed);
void make_board(Draft& draft);
void make_traffic(Draft& draft, bool has_round_things);
void make_balls(Draft& draft);
void make_cut(Draft& draft);
void make_polygons(Draft& draft);
void make_textures(Draft& draft);

}  // namespace ellipse::wild
