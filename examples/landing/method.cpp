// SPDX-License-Identifier: MIT
#include "examples/landing/method.hpp"

#include <cmath>
#include <stdexcept>

#include "core/scene/wild_shapes.hpp"
#include "examples/evaluate/text.hpp"
#include "examples/landing/apriltag_pad.hpp"
#include "examples/landing/peer_eye.hpp"
#include "examples/landing/pipeline_eye.hpp"
#include "examples/landing/whycon.hpp"

namespace landing {
namespace {

using Eigen::Vector2d;

constexpr double kShadowReach = 1000.0;  // half the length of a shadow; reaches the horizon [radii]

std::string properties_of(const std::string& method, const Rig& rig) {
  const std::size_t plus = method.find('+');
  if (plus == std::string::npos) {
    throw std::invalid_argument("method \"" + method +
                                "\": expected detector+tracking, apriltag or whycon");
  }
  return evaluate::format("detector=%s tracking=%s fx=%.17g target-diameter=%g",
                          method.substr(0, plus).c_str(),
                          method.substr(plus + 1).c_str(),
                          rig.camera.fx,
                          2.0 * rig.pad_radius);
}

// A shadow on a sheet, as a translucent black shape.
ellipse::Shape painted(const ellipse::Shadow& shadow) {
  const Vector2d normal(std::cos(shadow.direction_rad), std::sin(shadow.direction_rad));
  const Vector2d along = kShadowReach * Vector2d(-normal.y(), normal.x());
  const Vector2d middle = shadow.center * normal;
  ellipse::Shape shape = ellipse::wild::stroke(middle - along,
                                               middle + along,
                                               2.0 * shadow.half_width,
                                               {.level = 0.0, .opacity = shadow.depth});
  shape.softness = shadow.penumbra;
  return shape;
}

// The renderer does not shade sheets. Shadows are therefore added as translucent shapes on the
// marker.
void lay_marker(ellipse::Sheet marker, ellipse::Scene& scene) {
  scene.pad.pattern = ellipse::Pattern::kRing;
  for (const ellipse::Shadow& shadow : scene.light.shadows) {
    marker.shapes.push_back(painted(shadow));
  }
  scene.light.shadows.clear();
  scene.sheets.push_back(std::move(marker));
}

}  // namespace

void check_method(const std::string& method) {
  if (method == "apriltag") {
    (void)tag_sheet(ellipse::Pad{});
  } else if (method != "whycon") {
    (void)properties_of(method, {});
  }
}

void lay_pad(const std::string& method, ellipse::Scene& scene) {
  if (method == "apriltag") lay_marker(tag_sheet(scene.pad), scene);
  if (method == "whycon") lay_marker(roundel_sheet(scene.pad), scene);
}

std::unique_ptr<Eye> eye_of(const std::string& method,
                            const Rig& rig,
                            const ellipse::Pad& pad,
                            int rate) {
  const PictureFormat format{rig.camera.width, rig.camera.height, rate};
  if (method == "apriltag") {
    return std::make_unique<PeerEye>(format, make_apriltag(rig.camera, pad, rig.pad_radius));
  }
  if (method == "whycon") {
    return std::make_unique<PeerEye>(format, make_whycon(rig.camera, pad, rig.pad_radius));
  }
  return std::make_unique<PipelineEye>(format, properties_of(method, rig));
}

}  // namespace landing
