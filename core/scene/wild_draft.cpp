// SPDX-License-Identifier: MIT
#include "core/scene/wild_draft.hpp"

#include <algorithm>
#include <array>

namespace ellipse::wild {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

struct Size {
  int width;
  int height;
};

// Common sizes are listed several times.
constexpr std::array kSizes = {Size{226, 180},
                               Size{320, 240},
                               Size{320, 240},
                               Size{365, 256},
                               Size{480, 270},
                               Size{640, 360},
                               Size{640, 360},
                               Size{640, 360},
                               Size{640, 360},
                               Size{640, 480},
                               Size{640, 480},
                               Size{752, 480},
                               Size{960, 540},
                               Size{1024, 768},
                               Size{1280, 720}};
constexpr std::array kRates = {
    8.0, 10.0, 12.5, 15.0, 20.0, 24.0, 25.0, 30.0, 30.0, 50.0, 60.0, 78.0};

template <class Array>
const auto& any_of(Random& random, const Array& values) {
  return values[static_cast<std::size_t>(random.below(static_cast<int>(values.size())))];
}

}  // namespace

Draft::Draft(std::uint64_t seed, WildTheme theme) : random(hash(seed) ^ 0x77696c64U) {
  wild.theme = theme;
  wild.scene.seed = hash(seed);
  wild.scene.pad.pattern = Pattern::kNone;
  choose_format();
  choose_sensor();
  choose_shutter();
}

void Draft::choose_format() {
  const Size& size = any_of(random, kSizes);
  wild.width = size.width;
  wild.height = size.height;
  if (chance(0.02)) {
    wild.width = 1920;
    wild.height = 1080;
  }
  wild.frames_per_second = any_of(random, kRates);
  wild.scene.hfov_rad = random.between(0.5, 1.3);
}

void Draft::choose_sensor() {
  Sensor& sensor = wild.scene.sensor;
  contrast_ = chance(0.6) ? log_between(8.0, 200.0) : random.between(60.0, 200.0);
  if (contrast_ < 20.0) note("low-contrast");
  sensor.gain = log_between(0.3, 1.2);
  sensor.bias = chance(0.3) ? random.between(0.0, 16.0) : 0.0;
  if (chance(0.5)) {
    sensor.gamma = log_between(0.55, 1.7);
    note("gamma");
  }
  sensor.blur_px = log_between(0.4, 1.4);
  // Contrasts below three times the noise are rare in footage.
  sensor.read_noise = std::min(log_between(0.4, 12.0), contrast_ / 3.0);
  if (sensor.read_noise > 6.0) note("noise");
  sensor.shot_noise = chance(0.4) ? log_between(0.01, 0.2) : 0.0;
  if (chance(0.55)) {
    sensor.jpeg_quality = 15 + random.below(80);
    note("compression");
  }
}

void Draft::choose_shutter() {
  Sensor& sensor = wild.scene.sensor;
  const double frame_s = 1.0 / wild.frames_per_second;
  if (chance(0.3)) {
    sensor.exposure_s = std::min(0.015, frame_s) * random.between(0.1, 0.7);
    note("motion-blur");
  }
  if (chance(0.07)) {
    sensor.field_s = 0.5 * frame_s;
    note("interlaced");
  } else if (chance(0.25)) {
    sensor.readout_s = std::min(0.04, frame_s) * random.between(0.3, 0.95);
    note("rolling-shutter");
  }
}

void Draft::note(std::string_view thing) {
  const auto& known = wild.things;
  if (std::find(known.begin(), known.end(), thing) == known.end()) wild.things.push_back(thing);
}

double Draft::light(double grey) const {
  const Sensor& sensor = wild.scene.sensor;
  const double share = std::clamp((grey - sensor.bias) / 255.0, 0.0, 1.0);
  return 255.0 * std::pow(share, 1.0 / sensor.gamma) / sensor.gain;
}

Paint Draft::paint(double grey, double texture_greys, double grain) const {
  Paint paint;
  paint.level = light(grey);
  paint.texture = 0.5 * (light(grey + texture_greys) - light(grey - texture_greys));
  paint.grain = grain;
  return paint;
}

Greys Draft::greys() {
  const double half = 0.5 * contrast_;
  const double middle = random.between(22.0 + half, 248.0 - half);
  const double side = sign();
  return {middle - side * half, middle + side * half};
}

double Draft::focal_px() const {
  return 0.5 * wild.width / std::tan(0.5 * wild.scene.hfov_rad);
}

void Draft::ground(GroundKind kind, double grey, double contrast) {
  Ground& ground = wild.scene.ground;
  ground.kind = kind;
  ground.level = light(grey);
  ground.contrast = contrast * 0.05 * (light(grey + 10.0) - light(grey - 10.0));
}

void Draft::look(double unit_px, double tilt_rad, double azimuth_rad, double off_middle) {
  Flight& flight = wild.scene.flight;
  const double distance = focal_px() / unit_px;
  flight.path = Path::kAside;
  flight.period_s = random.between(5.0, 14.0);
  flight.lowest = distance * random.between(0.75, 1.0);
  flight.highest = distance * random.between(1.0, 1.5);
  flight.reach = log_between(0.15, 2.5);
  flight.begins_s = random.between(0.0, flight.period_s);
  flight.tilt_rad = tilt_rad;
  flight.azimuth_rad = azimuth_rad;
  flight.roll_rad = random.between(-0.3, 0.3);
  const double across = off_middle * random.between(-0.5, 0.5) * wild.width / unit_px;
  const double along = off_middle * random.between(-0.5, 0.5) * wild.height / unit_px /
                       std::max(std::cos(tilt_rad), 0.3);
  const Vector2d outwards(std::cos(azimuth_rad), std::sin(azimuth_rad));
  const Vector2d sideways(-outwards.y(), outwards.x());
  flight.aim.head<2>() = across * sideways + along * outwards;
}

Sheet& Draft::sheet(const Matrix3d& frame) {
  Sheet& sheet = wild.scene.sheets.emplace_back();
  sheet.frame = frame;
  return sheet;
}

Sheet& Draft::picture_sheet() {
  Sheet& made = sheet(Sheet{}.frame);
  made.anchor = Anchor::kPicture;
  return made;
}

void Draft::weather() {
  Light& light = wild.scene.light;
  if (chance(0.5)) light.gradient = {random.between(-0.5, 0.5), random.between(-0.4, 0.4)};
  if (chance(0.35)) {
    light.vignette = random.between(0.1, 0.55);
    note("vignette");
  }
}

void Draft::defocus(double semi_minor_px) {
  if (!chance(0.25)) return;
  const double limit = std::min(6.0, 0.3 * semi_minor_px);
  if (limit <= 1.5) return;
  wild.scene.sensor.blur_px = random.between(1.5, limit);
  note("defocus");
}

}  // namespace ellipse::wild
