#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/ellipse.hpp"

namespace ellipse {

/// What is painted on the pad. Lengths on the pad are in units of its ring's outer radius.
enum class Pattern {
  kRingX,  ///< A ring with a free-standing X inside.
  kRing,
  kDisc,
};

/// A band across the picture that hides what is behind it.
struct Bar {
  Eigen::Vector2d from_px;
  Eigen::Vector2d to_px;
  double width_px = 0.0;
  double level = 128.0;  ///< Grey level of its light.
};

/// A landing pad on textured ground. A value: the same one gives the same picture on any machine.
struct Scene {
  Pattern pattern = Pattern::kRingX;
  double ring_width = 0.205;       ///< Of the outer radius.
  double cross_length = 0.62;      ///< Half the length of the X's bars; to 1 - ring_width it joins.
  double cross_width = 0.2;        ///< Full width of the X's bars.
  double plate_half_width = 1.45;  ///< The square plate under the pattern; 0 = none.
  double paint_level = 55.0;       ///< Grey levels of the light, before gain and noise.
  double plate_level = 225.0;
  double ground_level = 120.0;
  double ground_contrast = 28.0;  ///< Amplitude of the ground's texture [grey levels].
  double gain = 1.0;              ///< 0.14 is dusk.
  double noise = 2.0;             ///< Standard deviation of the sensor's noise [grey levels].
  double blur_px = 0.6;           ///< Standard deviation of the lens's blur.
  std::vector<double> gaps_rad;   ///< Places where the ring is broken, by angle on the pad.
  double gap_width_rad = 0.1;
  std::vector<Bar> bars;
  std::uint64_t seed = 1;
};

/// A pinhole camera over the pad, whose centre is (0, 0, 0), x and y in its plane, z up; in units
/// of the ring's radius.
struct CameraPose {
  Eigen::Vector3d position{0.0, 0.0, 10.0};
  Eigen::Vector3d looks_at{0.0, 0.0, 0.0};
  double roll_rad = 0.0;  ///< About the optical axis.
};

/// An 8-bit picture to be written.
struct MutableImage {
  std::uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;
};

/// From the pad's plane to pixels. @param hfov_rad  Horizontal field of view.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const CameraPose& pose,
                                             double hfov_rad,
                                             int width,
                                             int height);

/// The affine view in which the ring's outer edge is exactly this ellipse.
[[nodiscard]] Eigen::Matrix3d image_from_pad(const Ellipse& outer_edge);

/// The exact image of a circle about the pad's centre. nullopt where it is not an ellipse, such as
/// when part of it is behind the camera. Conics map as C' = H^-T C H^-1 [HartleyZisserman2004] 2.3.
[[nodiscard]] std::optional<Ellipse> project_circle(const Eigen::Matrix3d& image_from_pad,
                                                    double radius);

/// Renders one frame, anti-aliased: each edge is a blurred step at its exact place.
/// @param frame  Number of the frame: the noise differs from frame to frame.
/// Deterministic, thread-safe, allocates nothing; O(pixels).
void render(const Scene& scene,
            const Eigen::Matrix3d& image_from_pad,
            std::uint64_t frame,
            const MutableImage& picture);

/// Where the camera is at a time [s] of an approach: from 20 radii up and aside down to 2.6 radii,
/// and back up again, each in `duration_s`, with the small motions of a flying vehicle.
[[nodiscard]] CameraPose approach_pose(double time_s, double duration_s);

}  // namespace ellipse
