// SPDX-License-Identifier: MIT
//
// Wild scenes of an eye. A unit is the radius of the iris.
#include <algorithm>

#include "core/scene/wild_draft.hpp"

namespace ellipse::wild {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kHalfWidth = 12.0;  // of the modelled face

// Grey levels of an eye in infrared light.
struct Tones {
  double skin;
  double sclera;
  double iris;
  double pupil;
};

Tones choose_tones(Draft& draft) {
  Random& random = draft.random;
  Tones tones{};
  tones.pupil = random.between(8.0, 70.0);
  const double contrast =
      draft.chance(0.4) ? draft.log_between(8.0, 110.0) : draft.random.between(40.0, 110.0);
  if (contrast < 20.0) draft.note("low-contrast");
  tones.iris = tones.pupil + contrast;
  tones.sclera = std::min(245.0, tones.iris + draft.log_between(10.0, 110.0));
  tones.skin = random.between(60.0, 200.0);
  Sensor& sensor = draft.scene().sensor;
  sensor.read_noise = std::min(sensor.read_noise, contrast / 3.0);
  return tones;
}

// The frame of an eyeball that is turned sideways.
Matrix3d gaze_frame(Draft& draft) {
  const double aside = draft.random.between(0.0, 0.6);
  const double direction = draft.random.between(0.0, kTwoPi);
  const Vector3d axis(std::cos(direction), std::sin(direction), 0.0);
  const Matrix3d turn = Eigen::AngleAxisd(aside, axis).toRotationMatrix();
  Matrix3d frame;
  frame << turn.col(0), -turn.col(1), Vector3d(0.0, 0.0, 0.0);
  // The centre of the iris moves on a sphere of 1.6 radii of the iris.
  const Vector3d normal = turn.col(2);
  frame.col(2).head<2>() = 1.6 * normal.head<2>();
  return frame;
}

void add_eyeball(Draft& draft, const Tones& tones) {
  Random& random = draft.random;
  Sheet& white = draft.sheet(level_frame({0.0, 0.0, 0.0}, 1.0, 0.0));
  white.shapes.push_back(box({0.0, 0.0}, {5.0, 3.0}, 0.0, draft.paint(tones.sclera, 5.0, 1.0)));
  Sheet& ball = draft.sheet(gaze_frame(draft));
  ball.swing = {Vector3d(random.between(-0.7, 0.7), random.between(-0.4, 0.4), 0.0),
                random.between(1.5, 6.0),
                random.between(0.0, kTwoPi),
                draft.chance(0.5) ? 1 : 3};
  Shape iris = disc({0.0, 0.0}, 1.0, draft.paint(tones.iris, 6.0, random.between(4.0, 12.0)));
  iris.softness = draft.log_between(0.01, 0.1);
  iris.is_listed = true;
  ball.shapes.push_back(iris);
  draft.note("soft-edge");
  Shape pupil = disc({random.between(-0.06, 0.06), random.between(-0.06, 0.06)},
                     random.between(0.22, 0.65),
                     draft.paint(tones.pupil, 2.0));
  pupil.outline = Outline::kWavy;
  pupil.amount = draft.log_between(0.004, 0.03);
  pupil.seed = draft.seed();
  pupil.softness = draft.log_between(0.01, 0.06);
  pupil.is_listed = true;
  pupil.is_target = true;
  pupil.sheet_from_shape.scale(Vector2d(1.0, random.between(0.9, 1.0)));
  ball.shapes.push_back(pupil);
  draft.note("pupil");
}

// Lamps reflected in the cornea; they stay in place while the eye moves.
void add_reflections(Draft& draft) {
  Random& random = draft.random;
  Sheet& cornea = draft.sheet(level_frame({0.0, 0.0, 0.0}, 1.0, 0.0));
  for (int i = random.below(4); i > 0; --i) {
    const Vector2d at(random.between(-0.7, 0.7), random.between(-0.6, 0.6));
    const double size = draft.log_between(0.05, 0.16);
    const Paint bright = draft.paint(random.between(200.0, 254.0));
    if (draft.chance(0.4)) {
      Shape lamp = disc(at, size, bright);
      lamp.is_listed = true;
      cornea.shapes.push_back(lamp);
    } else {
      cornea.shapes.push_back(blot(at, 1.5 * size, bright, draft.seed()));
    }
    draft.note("glint");
  }
}

// Half of the face from a lid's edge on. @param side  -1: the upper one.
void add_lid(Draft& draft, const Tones& tones, double side, double opening, double blink) {
  Random& random = draft.random;
  Sheet& lid = draft.sheet(level_frame({0.0, 0.0, 0.0}, 1.0, 0.0));
  lid.frame.col(1) *= -1.0;  // y down
  lid.swing = {
      Vector3d(0.0, side * blink, 0.0), random.between(1.0, 4.0), random.between(0.0, kTwoPi), 12};
  const double bow = random.between(0.06, 0.14);
  const auto edge = [&](double x) { return side * (opening - bow * x * x); };
  std::vector<Vector2d> outline{{kHalfWidth, side * 9.0}, {-kHalfWidth, side * 9.0}};
  constexpr int kPoints = 40;
  for (int i = 0; i <= kPoints; ++i) {
    const double x = kHalfWidth * (2.0 * i / kPoints - 1.0);
    outline.emplace_back(x, edge(x));
  }
  Shape skin = polygon(outline, draft.paint(tones.skin, 9.0, random.between(0.5, 3.0)));
  skin.softness = draft.log_between(0.01, 0.08);
  lid.shapes.push_back(skin);
  // The rim, a fold of the lid and the lashes.
  const Paint dark = draft.paint(std::max(8.0, tones.skin - random.between(20.0, 60.0)));
  for (int i = 0; i < 12; ++i) {
    const double x = -3.0 + 0.5 * i;
    lid.shapes.push_back(
        stroke({x, edge(x) + 0.05 * side}, {x + 0.5, edge(x + 0.5) + 0.05 * side}, 0.07, dark));
    lid.shapes.push_back(
        stroke({x, edge(x) + 0.7 * side}, {x + 0.5, edge(x + 0.5) + 0.72 * side}, 0.05, dark));
  }
  draft.note("lid");
  if (!draft.chance(0.7)) return;
  draft.note("lashes");
  const Paint black = draft.paint(random.between(8.0, 50.0));
  for (int i = 10 + random.below(25); i > 0; --i) {
    const double x = random.between(-2.8, 2.8);
    const Vector2d root(x, edge(x));
    const double length = random.between(0.3, 0.9);
    // Some lashes hang over the eye instead of pointing away.
    const double towards = draft.chance(0.35) ? -side : side;
    const Vector2d tip =
        root + length * Vector2d(0.25 * x + random.between(-0.3, 0.3), 0.8 * towards);
    lid.shapes.push_back(stroke(root, tip, random.between(0.015, 0.05), black));
  }
}

void add_eyebrow(Draft& draft, const Tones& tones) {
  if (!draft.chance(0.5)) return;
  Random& random = draft.random;
  Sheet& brow = draft.sheet(level_frame({0.0, 0.0, 0.0}, 1.0, 0.0));
  for (int i = 0; i < 60; ++i) {
    const double x = random.between(-4.0, 4.0);
    const Vector2d root(x, 3.3 - 0.08 * x * x + random.between(-0.3, 0.3));
    const Vector2d tip = root + Vector2d(random.between(0.3, 0.8), random.between(0.0, 0.3));
    brow.shapes.push_back(stroke(root, tip, 0.06, draft.paint(0.5 * tones.skin)));
  }
}

}  // namespace

void make_eye(Draft& draft, bool is_closed) {
  const double unit_px = draft.wild.height * draft.random.between(0.12, 0.32);
  draft.look(unit_px, draft.random.between(0.0, 0.4), draft.random.between(-2.0, -1.1), 0.3);
  draft.scene().flight.reach *= 0.2;
  draft.defocus(0.25 * unit_px);
  const Tones tones = choose_tones(draft);
  draft.ground(GroundKind::kPlain, tones.skin, 0.0);
  draft.weather();
  if (!is_closed) {
    add_eyeball(draft, tones);
    add_reflections(draft);
  }
  const double upper = is_closed ? 0.0 : draft.random.between(0.35, 1.1);
  const double lower = is_closed ? 0.0 : draft.random.between(0.6, 1.2);
  const double blink = !is_closed && draft.chance(0.5) ? upper + lower : 0.0;
  if (blink > 0.0) draft.note("blink");
  add_lid(draft, tones, 1.0, lower, 0.0);
  add_lid(draft, tones, -1.0, upper, blink);
  add_eyebrow(draft, tones);
  if (draft.chance(0.06)) draft.limb();
}

}  // namespace ellipse::wild
