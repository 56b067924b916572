// SPDX-License-Identifier: MIT
#include "examples/landing/camera_view.hpp"

namespace landing {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d Rig::body_from_camera() const {
  // Camera pointing down: its x is the body's -y, its y points backwards, its top forward.
  Matrix3d down;
  down << 0.0, -1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0;
  return Eigen::AngleAxisd(-pitch_rad, Vector3d::UnitY()).toRotationMatrix() * down;
}

ellipse::View view_of(const Rig& rig, const Motion& vehicle, const Platform& platform) {
  const Matrix3d world_from_body = vehicle.world_from_body.toRotationMatrix();
  const Matrix3d camera_from_world = (world_from_body * rig.body_from_camera()).transpose();
  const Vector3d camera = vehicle.position + world_from_body * rig.position;
  const Vector3d pad(platform.position().x(), platform.position().y(), 0.0);
  const Eigen::AngleAxisd world_from_pad(platform.heading_rad(), Vector3d::UnitZ());
  const Vector3d camera_on_pad = (world_from_pad.inverse() * (camera - pad)) / rig.pad_radius;

  ellipse::View view;
  Matrix3d plane;
  plane << camera_from_world * world_from_pad.toRotationMatrix().leftCols<2>(),
      camera_from_world * (pad - camera) / rig.pad_radius;
  view.image_from_pad = rig.camera.matrix() * plane;
  view.camera = camera_on_pad;
  view.ground_from_pad = Eigen::Translation2d(platform.position() / rig.pad_radius) *
                         Eigen::Rotation2Dd(platform.heading_rad());
  return view;
}

Vector3d gravity_of(const Rig& rig, const Motion& vehicle) {
  return rig.body_from_camera().transpose() *
         (vehicle.world_from_body.conjugate() * -Vector3d::UnitZ());
}

Vector3d pad_from_body(const Rig& rig, const Motion& vehicle, const Vector3d& pad_in_camera) {
  return vehicle.world_from_body * (rig.body_from_camera() * pad_in_camera + rig.position);
}

Vector3d errors_from_body(const Rig& rig, const Motion& vehicle, const Matrix3d& covariance) {
  const Matrix3d world_from_camera =
      vehicle.world_from_body.toRotationMatrix() * rig.body_from_camera();
  return (world_from_camera * covariance * world_from_camera.transpose()).diagonal().cwiseSqrt();
}

}  // namespace landing
