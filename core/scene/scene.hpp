#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/scene/flight.hpp"
#include "core/scene/ground.hpp"
#include "core/scene/pad.hpp"
#include "core/scene/sensor.hpp"
#include "core/scene/sheet.hpp"

namespace ellipse {

/// An opaque band in front of the camera: a leg of the vehicle, a cable.
/// Lengths are in widths of the picture, from its middle, x right, y down.
struct Bar {
  Eigen::Vector2d from{0.0, 0.0};
  Eigen::Vector2d to{0.0, 0.0};
  double width = 0.0;
  double level = 128.0;             ///< Grey level of its light at gain 1.
  Eigen::Vector2d swing{0.0, 0.0};  ///< Amplitude of its swing, with a period of four seconds.
};

/// The shadow of a straight object: a band on the pad's plane. Lengths in radii of the pad.
struct Shadow {
  double direction_rad = 0.0;  ///< Of the band's normal.
  double center = 0.0;         ///< Of the band, along its normal.
  double half_width = 1.0;
  double depth = 0.5;     ///< Share of the light missing in it.
  double penumbra = 0.0;  ///< Softness of its edges [radii], besides the lens blur.
};

/// The sun's reflection on the pad's plane.
struct Glare {
  Eigen::Vector2d tilt{0.0, 0.0};  ///< Position below the camera, in units of its height.
  double spread = 0.1;             ///< Standard deviation, in units of the camera's height.
  double level = 0.0;              ///< Light added at its middle [grey levels].
};

/// The light on the scene.
struct Light {
  Eigen::Vector2d gradient{0.0, 0.0};  ///< Relative change over the picture's width, by x and y.
  std::vector<Shadow> shadows;
  Glare glare;
  double vignette = 0.0;  ///< Share of the light missing in the corners; grows with the square
                          ///< of the distance from the middle.
};

/// Distortion of a lens.
struct Distortion {
  LensModel model = LensModel::kBrownConrady;
  std::array<double, 8> coefficients{};  ///< In the order of the model; the rest is 0.
};

/// A landing pad on the ground under a flying camera. A value: equal scenes give equal pictures on
/// any machine.
struct Scene {
  Pad pad;
  Ground ground;
  Light light;
  Sensor sensor;
  Flight flight;
  std::vector<Sheet> sheets;  ///< On and over the ground and the pad, drawn in this order.
  std::vector<Bar> bars;
  double hfov_rad = 1.012;  ///< Horizontal field of view, from border to border of the picture.
  std::optional<Distortion> lens;  ///< None = a pinhole.
  std::uint64_t seed = 1;          ///< Of all random content.
};

/// Ground truth of a frame's target: the pad in a scene without sheets, otherwise the largest
/// target in the frame, without inner_edge. The ellipses are in the ideal plane, which is the
/// picture itself without distortion. See true_ellipses() for all ellipses of a frame.
struct Truth {
  std::optional<Ellipse> outer_edge;  ///< The exact image of the painted circle [px].
  std::optional<Ellipse> inner_edge;  ///< Of the next edge inside it [px].
  double visible_fraction = 0.0;      ///< Share of the outer edge's length inside the frame.
};

/// A view of a pad by an external camera without a Flight; the pad may move.
struct View {
  Eigen::Matrix3d image_from_pad;           ///< The pad's plane to pixels of the ideal plane.
  std::optional<Eigen::Vector3d> camera{};  ///< On the pad [radii]; without it there is no glare.
  /// Pose of the pad on the ground [radii]; the ground passes beneath a moving pad.
  Eigen::Isometry2d ground_from_pad = Eigen::Isometry2d::Identity();
};

/// The camera of a scene: its lens, and the focal length at which the picture spans hfov_rad
/// between the outer edges of its first and last column.
/// Throws std::invalid_argument if the lens does not cover this field of view.
[[nodiscard]] Camera camera_of(const Scene& scene, int width, int height);

/// For a picture without distortion.
[[nodiscard]] Truth truth_of(const Pad& pad,
                             const Eigen::Matrix3d& image_from_pad,
                             int width,
                             int height);

/// For a camera's picture. Measures the length of the distorted outline in steps of at most a
/// pixel; beyond the lens's range it follows the limit and counts as outside the frame.
/// @param image_from_pad  To the ideal plane.
/// Thread-safe; allocates nothing.
[[nodiscard]] Truth truth_of(const Pad& pad,
                             const Eigen::Matrix3d& image_from_pad,
                             const Camera& camera);

/// Share of the distorted outline's length inside the frame.
[[nodiscard]] double share_in_frame(const Ellipse& ideal, const Camera& camera);

/// A scene camera's view of a sheet in the ideal plane; `time_s` is the time of the middle row.
/// nullopt for a ball that is not in front of the camera.
[[nodiscard]] std::optional<SheetView> view_of(const Sheet& sheet,
                                               const Scene& scene,
                                               const Camera& camera,
                                               double time_s);

/// Homography from the pad's plane to the scene camera's ideal plane [px] at a time.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const Scene& scene,
                                             double time_s,
                                             int width,
                                             int height);

}  // namespace ellipse
