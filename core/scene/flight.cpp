// SPDX-License-Identifier: MIT
#include "core/scene/flight.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace ellipse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

// 0 at the period's begin and end, 1 in its middle.
double progress_of(const Flight& flight, double time_s) {
  return 0.5 - 0.5 * std::cos(2.0 * kPi * time_s / flight.period_s);
}

double distance_at(const Flight& flight, double progress) {
  return flight.highest * std::pow(flight.lowest / flight.highest, progress);
}

Vector3d sway(double distance, double time_s) {
  return 0.04 * distance * Vector3d(std::sin(1.7 * time_s), std::sin(1.1 * time_s + 1.0), 0.0);
}

CameraPose hovering(double height, double time_s) {
  CameraPose pose;
  pose.position = Vector3d(0.0, 0.0, height) + sway(height, time_s);
  pose.looks_at = 0.5 * sway(height, 0.7 * time_s);
  pose.roll_rad = 0.35 * std::sin(0.4 * time_s);
  return pose;
}

CameraPose approaching(const Flight& flight, double time_s) {
  const double progress = progress_of(flight, time_s);
  const double height = distance_at(flight, progress);
  CameraPose pose;
  pose.position = height * (1.0 - progress) * Vector3d(0.45, -0.55, 0.0) +
                  Vector3d(0.0, 0.0, height) + sway(height, time_s);
  const double wander = height * (1.0 - 0.8 * progress);
  pose.looks_at =
      wander * Vector3d(0.12 * std::sin(0.9 * time_s), 0.08 * std::sin(1.3 * time_s), 0.0);
  pose.roll_rad = 0.35 * std::sin(0.4 * time_s);
  return pose;
}

// View from a direction given by its angle to the vertical and its azimuth.
CameraPose tilted(double distance, double from_vertical_rad, double azimuth_rad, double time_s) {
  CameraPose pose;
  pose.position = distance * Vector3d(std::sin(from_vertical_rad) * std::cos(azimuth_rad),
                                      std::sin(from_vertical_rad) * std::sin(azimuth_rad),
                                      std::cos(from_vertical_rad)) +
                  sway(distance, time_s);
  pose.looks_at = sway(distance, 0.7 * time_s);
  return pose;
}

CameraPose dashing(const Flight& flight, double time_s) {
  // 200 px to each side at 6 rad/s are 1200 px/s, with a focal length of 577 px.
  constexpr double kReach = 200.0 / 577.0;
  CameraPose pose = hovering(flight.lowest, time_s);
  const double aside = flight.reach * kReach * flight.lowest * std::sin(6.0 * time_s);
  pose.position.x() += aside;
  pose.looks_at.x() += aside;
  return pose;
}

CameraPose shaking(const Flight& flight, double time_s) {
  CameraPose pose = hovering(flight.lowest, time_s);
  const double amplitude = flight.reach * 0.02 * flight.lowest;
  pose.looks_at +=
      amplitude *
      Vector3d(std::sin(2.0 * kPi * 7.3 * time_s), std::sin(2.0 * kPi * 9.1 * time_s + 0.5), 0.0);
  pose.roll_rad += 0.01 * std::sin(2.0 * kPi * 10.7 * time_s);
  return pose;
}

CameraPose reentering(const Flight& flight, double time_s) {
  CameraPose pose = hovering(flight.lowest, time_s);
  const double turn = 2.0 * kPi * time_s / flight.period_s;
  const Vector3d away = flight.reach * flight.lowest *
                        Vector3d(0.85 * std::sin(turn), 0.3 * std::sin(2.0 * turn), 0.0);
  pose.position += 0.3 * away;
  pose.looks_at += away;
  return pose;
}

CameraPose aside(const Flight& flight, double time_s) {
  const double distance = distance_at(flight, progress_of(flight, time_s));
  CameraPose pose = tilted(distance, flight.tilt_rad, flight.azimuth_rad, 0.0);
  const double turn = 2.0 * kPi * time_s / flight.period_s;
  const Vector3d sideways(std::sin(5.3 * turn), std::sin(4.1 * turn + 1.0), 0.0);
  pose.position += flight.aim + 0.04 * flight.reach * distance * sideways;
  const Vector3d away(std::sin(3.7 * turn), std::sin(6.1 * turn + 2.0), 0.0);
  pose.looks_at = flight.aim + 0.06 * flight.reach * distance * away;
  pose.roll_rad = flight.roll_rad + 0.1 * flight.reach * std::sin(2.9 * turn);
  return pose;
}

}  // namespace

CameraPose pose_at(const Flight& flight, double since_s) {
  const double time_s = since_s + flight.begins_s;
  const double turn = 2.0 * kPi * time_s / flight.period_s;
  switch (flight.path) {
    case Path::kApproach:
      return approaching(flight, time_s);
    case Path::kOblique:
      return tilted(distance_at(flight, progress_of(flight, time_s)),
                    kPi / 3.0,
                    -1.3 + 0.4 * std::sin(turn),
                    time_s);
    case Path::kOrbit:
      return tilted(flight.highest, kPi / 4.0, turn, time_s);
    case Path::kDash:
      return dashing(flight, time_s);
    case Path::kShake:
      return shaking(flight, time_s);
    case Path::kReenter:
      return reentering(flight, time_s);
    case Path::kAside:
      return aside(flight, time_s);
    case Path::kHover:
      break;
  }
  return hovering(flight.lowest, time_s);
}

Matrix3d image_from_pad(const CameraPose& pose, const Camera& camera) {
  const Vector3d forward = (pose.looks_at - pose.position).normalized();
  const Vector3d north(0.0, 1.0, 0.0);
  const Vector3d right = forward.cross(north).normalized();
  const Vector3d down = forward.cross(right);
  Matrix3d camera_from_pad;
  camera_from_pad << right.transpose(), down.transpose(), forward.transpose();
  camera_from_pad =
      Eigen::AngleAxisd(pose.roll_rad, Vector3d::UnitZ()).toRotationMatrix() * camera_from_pad;
  Matrix3d plane;
  plane << camera_from_pad.leftCols<2>(), -camera_from_pad * pose.position;
  return camera.matrix() * plane;
}

Matrix3d image_from_pad(const CameraPose& pose, double hfov_rad, int width, int height) {
  return image_from_pad(pose, Camera::with_hfov(hfov_rad, width, height));
}

}  // namespace ellipse
