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

/// A band in front of the camera that hides what is behind it: a leg of the vehicle, a cable.
/// Lengths are in widths of the picture, from its middle, x right, y down.
struct Bar {
  Eigen::Vector2d from{0.0, 0.0};
  Eigen::Vector2d to{0.0, 0.0};
  double width = 0.0;
  double level = 128.0;             ///< Grey level of its light at gain 1.
  Eigen::Vector2d swing{0.0, 0.0};  ///< It swings this far to both sides, once in four seconds.
};

/// The shadow of a straight object: a band on the pad's plane. Lengths in radii of the pad.
struct Shadow {
  double direction_rad = 0.0;  ///< Of the band's normal.
  double center = 0.0;         ///< Of the band, along its normal.
  double half_width = 1.0;
  double depth = 0.5;     ///< Share of the light that is missing in it.
  double penumbra = 0.0;  ///< Softness of its edges [radii], beside the lens's.
};

/// The sun's mirror image on the pad's plane.
struct Glare {
  Eigen::Vector2d tilt{0.0, 0.0};  ///< Where it lies below the camera, in units of its height.
  double spread = 0.1;             ///< Standard deviation, in units of the camera's height.
  double level = 0.0;              ///< Light added at its middle [grey levels].
};

/// The light on the scene.
struct Light {
  Eigen::Vector2d gradient{0.0, 0.0};  ///< Relative change over the picture's width, by x and y.
  std::vector<Shadow> shadows;
  Glare glare;
  double vignette = 0.0;  ///< Share of the light that the corners lack; it falls with the square
                          ///< of the distance from the middle.
};

/// How a lens distorts the picture.
struct Distortion {
  LensModel model = LensModel::kBrownConrady;
  std::array<double, 8> coefficients{};  ///< In the order of the model; the rest is 0.
};

/// A landing pad on the ground under a flying camera. A value: the same one gives the same
/// pictures on any machine.
struct Scene {
  Pad pad;
  Ground ground;
  Light light;
  Sensor sensor;
  Flight flight;
  std::vector<Sheet> sheets;  ///< On and over the ground and the pad, each over the ones before.
  std::vector<Bar> bars;
  double hfov_rad = 1.012;  ///< Horizontal field of view, from border to border of the picture.
  std::optional<Distortion> lens;  ///< None = a pinhole.
  std::uint64_t seed = 1;          ///< Of all that is random.
};

/// What a frame shows of its target: the pad or, where the scene has none, the largest of the
/// sheets' targets in the frame. The ellipses are of the ideal plane: of the picture itself, where
/// no lens bends it. See true_ellipses() for all ellipses of a frame.
struct Truth {
  std::optional<Ellipse> outer_edge;  ///< The exact image of the painted circle [px].
  std::optional<Ellipse> inner_edge;  ///< Of the edge next inside it [px].
  double visible_fraction = 0.0;      ///< Share of the outer edge's length inside the frame.
};

/// How a camera of its own sees a pad: one that flies by no Flight, over a pad that may move.
struct View {
  Eigen::Matrix3d image_from_pad;           ///< The pad's plane to pixels of the ideal plane.
  std::optional<Eigen::Vector3d> camera{};  ///< On the pad [radii]; without it there is no glare.
  /// The pad on the ground [radii]; the ground is seen to pass beneath a pad that moves.
  Eigen::Isometry2d ground_from_pad = Eigen::Isometry2d::Identity();
};

/// The camera that a scene is seen by: its lens, and the focal length at which the picture shows
/// hfov_rad between the outer edges of its first and last column.
/// Throws std::invalid_argument where the lens does not show as much.
[[nodiscard]] Camera camera_of(const Scene& scene, int width, int height);

/// Of a picture that no lens bends.
[[nodiscard]] Truth truth_of(const Pad& pad,
                             const Eigen::Matrix3d& image_from_pad,
                             int width,
                             int height);

/// Of a camera's picture. The outline's length is that of the bent one, summed in steps of at most
/// a pixel; where the lens ends, it runs along the end and is not in the frame.
/// @param image_from_pad  To the ideal plane.
/// Thread-safe; allocates nothing.
[[nodiscard]] Truth truth_of(const Pad& pad,
                             const Eigen::Matrix3d& image_from_pad,
                             const Camera& camera);

/// Share of the length of an ideal plane's ellipse that is in the frame.
[[nodiscard]] double share_in_frame(const Ellipse& ideal, const Camera& camera);

/// How the camera of a scene sees a sheet in the ideal plane, its middle row at a time; nullopt
/// where it is a ball that is not before the camera.
[[nodiscard]] std::optional<SheetView> view_of(const Sheet& sheet,
                                               const Scene& scene,
                                               const Camera& camera,
                                               double time_s);

/// Where the camera of a scene sees the pad's plane at a time, in its ideal plane [px].
[[nodiscard]] Eigen::Matrix3d image_from_pad(const Scene& scene,
                                             double time_s,
                                             int width,
                                             int height);

}  // namespace ellipse
