// SPDX-License-Identifier: MIT
#include "examples/landing/map.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "examples/evaluate/text.hpp"

namespace landing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFiner = 3;        // supersampling factor
constexpr int kPlanWidth = 400;  // the height scale is to its right [px]
constexpr double kPxPerM = 20.0;
constexpr double kGrid = 2.5;        // [m]
constexpr double kMaxHeight = 12.0;  // top of the height scale [m]
constexpr double kFarthest = 60.0;   // largest drawn distance of a footprint corner [m]

const cv::Scalar kPaper(247, 245, 240);
const cv::Scalar kLine(226, 222, 213);
const cv::Scalar kInk(60, 60, 64);
const cv::Scalar kFaint(140, 138, 132);
const cv::Scalar kPlatform(217, 116, 43);
const cv::Scalar kVehicle(42, 127, 63);
const cv::Scalar kBlind(190, 50, 50);
const cv::Scalar kView(222, 232, 222);

}  // namespace

const cv::Mat& Map::draw(const Moment& moment) {
  middle_ = moment.platform;
  platform_way_.push_back(moment.platform);
  vehicle_way_.push_back(moment.vehicle.position.head<2>());
  was_seen_.push_back(moment.is_visible);

  canvas_.create(kFiner * kHeight, kFiner * kWidth, CV_8UC3);
  canvas_.setTo(kPaper);
  draw_footprint(moment);
  draw_grid();
  draw_ways();
  draw_platform(moment);
  draw_vehicle(moment);
  draw_height(moment);
  write_figures(moment);
  cv::resize(canvas_, shown_, {kWidth, kHeight}, 0.0, 0.0, cv::INTER_AREA);
  return shown_;
}

cv::Point Map::at(const Vector2d& point) const {
  const Vector2d px = kFiner * kPxPerM * (point - middle_);
  return {static_cast<int>(std::lround(0.5 * kFiner * kPlanWidth + px.x())),
          static_cast<int>(std::lround(0.5 * kFiner * kHeight - px.y()))};
}

void Map::draw_grid() {
  const Vector2d half(0.5 * kPlanWidth / kPxPerM, 0.5 * kHeight / kPxPerM);
  const Vector2d first = ((middle_ - half) / kGrid).array().floor() * kGrid;
  for (double x = first.x(); x <= middle_.x() + half.x(); x += kGrid) {
    cv::line(canvas_, at({x, middle_.y() - half.y()}), at({x, middle_.y() + half.y()}), kLine, 2);
  }
  for (double y = first.y(); y <= middle_.y() + half.y(); y += kGrid) {
    cv::line(canvas_, at({middle_.x() - half.x(), y}), at({middle_.x() + half.x(), y}), kLine, 2);
  }
}

void Map::draw_ways() {
  for (std::size_t i = 1; i < platform_way_.size(); ++i) {
    cv::line(canvas_, at(platform_way_[i - 1]), at(platform_way_[i]), kPlatform, 4, cv::LINE_AA);
    cv::line(canvas_,
             at(vehicle_way_[i - 1]),
             at(vehicle_way_[i]),
             was_seen_[i] ? kVehicle : kBlind,
             5,
             cv::LINE_AA);
  }
}

// The camera's footprint on the ground; not drawn if a corner of the picture shows the sky.
void Map::draw_footprint(const Moment& moment) {
  const Rig& rig = flight_.rig;
  const Eigen::Matrix3d ray = rig.camera.matrix().inverse();
  const Vector3d from = moment.vehicle.position + moment.vehicle.world_from_body * rig.position;
  std::vector<cv::Point> corners;
  const double right = rig.camera.width - 0.5;
  const double bottom = rig.camera.height - 0.5;
  for (const Vector2d& pixel : {Vector2d(-0.5, -0.5),
                                Vector2d(right, -0.5),
                                Vector2d(right, bottom),
                                Vector2d(-0.5, bottom)}) {
    const Vector3d way =
        moment.vehicle.world_from_body * (rig.body_from_camera() * (ray * pixel.homogeneous()));
    const double distance = -from.z() / way.z();
    if (!(way.z() < 0.0) || distance > kFarthest) return;
    corners.push_back(at((from + distance * way).head<2>()));
  }
  cv::fillConvexPoly(canvas_, corners, kView, cv::LINE_AA);
}

void Map::draw_platform(const Moment& moment) {
  const double radius = flight_.rig.pad_radius;
  const Eigen::Rotation2Dd turn(moment.heading_rad);
  std::vector<cv::Point> plate;
  for (const Vector2d& corner :
       {Vector2d(1.0, 1.0), Vector2d(-1.0, 1.0), Vector2d(-1.0, -1.0), Vector2d(1.0, -1.0)}) {
    plate.push_back(at(moment.platform + 1.45 * radius * (turn * corner)));
  }
  cv::polylines(canvas_, plate, true, kPlatform, 4, cv::LINE_AA);
  const int size = static_cast<int>(std::lround(kFiner * kPxPerM * radius));
  cv::circle(canvas_, at(moment.platform), size, kPlatform, 9, cv::LINE_AA);
}

// Draws four rotors; the front ones are filled.
void Map::draw_vehicle(const Moment& moment) {
  const Eigen::Matrix3d world_from_body = moment.vehicle.world_from_body.toRotationMatrix();
  const cv::Scalar& colour = moment.is_visible ? kVehicle : kBlind;
  for (const Vector3d& arm : {Vector3d(0.28, 0.28, 0.0),
                              Vector3d(0.28, -0.28, 0.0),
                              Vector3d(-0.28, 0.28, 0.0),
                              Vector3d(-0.28, -0.28, 0.0)}) {
    const Vector3d rotor = moment.vehicle.position + world_from_body * arm;
    const cv::Point center = at(rotor.head<2>());
    cv::line(canvas_, at(moment.vehicle.position.head<2>()), center, colour, 6, cv::LINE_AA);
    cv::circle(canvas_, center, 12, colour, arm.x() > 0.0 ? cv::FILLED : 4, cv::LINE_AA);
  }
}

void Map::draw_height(const Moment& moment) {
  const int x = kFiner * (kPlanWidth + 36);
  const int bottom = kFiner * (kHeight - 24);
  const int top = kFiner * 44;
  cv::rectangle(canvas_,
                cv::Point(kFiner * kPlanWidth, 0),
                cv::Point(kFiner * kWidth, kFiner * kHeight),
                kPaper,
                cv::FILLED);
  const auto y_of = [&](double height) {
    const double share = std::clamp(height / kMaxHeight, 0.0, 1.0);
    return static_cast<int>(std::lround(bottom + share * (top - bottom)));
  };
  cv::line(canvas_, {x, bottom}, {x, top}, kFaint, 3);
  for (int height = 0; height <= static_cast<int>(kMaxHeight); height += 2) {
    cv::line(canvas_, {x, y_of(height)}, {x + 15, y_of(height)}, kFaint, 3);
    write(std::to_string(height), x / kFiner + 9, y_of(height) / kFiner + 4, 0.35, kFaint);
  }
  write("m", kPlanWidth + 45, 32, 0.35, kFaint);
  const cv::Scalar& colour = moment.is_visible ? kVehicle : kBlind;
  const int y = y_of(moment.vehicle.position.z());
  cv::line(canvas_, {x, bottom}, {x, y}, colour, 12, cv::LINE_AA);
  cv::circle(canvas_, {x, y}, 16, colour, cv::FILLED, cv::LINE_AA);
}

void Map::write_figures(const Moment& moment) {
  const double off = (moment.vehicle.position.head<2>() - moment.platform).norm();
  const double drift = (moment.vehicle.velocity.head<2>() - moment.platform_velocity).norm();
  write(kPhaseNames.at(static_cast<std::size_t>(moment.phase)), 12, 26, 0.62, kInk);
  write(evaluate::format("%5.1f s   off %.2f m   drift %.2f m/s", moment.time_s, off, drift),
        12,
        kHeight - 12,
        0.4,
        kInk);
}

void Map::write(const std::string& text, int x, int y, double size, const cv::Scalar& colour) {
  cv::putText(canvas_,
              text,
              {kFiner * x, kFiner * y},
              cv::FONT_HERSHEY_SIMPLEX,
              kFiner * size,
              colour,
              kFiner,
              cv::LINE_AA);
}

}  // namespace landing
