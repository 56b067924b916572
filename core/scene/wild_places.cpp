// SPDX-License-Identifier: MIT
//
// Wild scenes of boards, balls and large ellipses, and scenes without any ellipse.
#include <algorithm>
#include <array>
#include <numbers>

#include "core/scene/wild_draft.hpp"

namespace ellipse::wild {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

void add_board(Draft& draft, const Vector2d& at, int columns, int rows, const Greys& greys) {
  Random& random = draft.random;
  Sheet& sheet = draft.sheet(level_frame({at.x(), at.y(), 0.0}, 1.0, 0.0));
  const Vector2d half(0.5 * columns + 0.5, 0.5 * rows + 0.5);
  sheet.shapes.push_back(box({0.0, 0.0}, half, 0.0, draft.paint(greys.around, 2.0, 0.5)));
  const double radius = random.between(0.22, 0.4);
  const double hole = draft.chance(0.5) ? random.between(0.4, 0.8) : 0.0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      Shape dot = disc(
          {column - 0.5 * (columns - 1), row - 0.5 * (rows - 1)}, radius, draft.paint(greys.paint));
      dot.hole = hole;
      dot.is_listed = true;
      dot.is_target = true;
      sheet.shapes.push_back(dot);
    }
  }
  if (!draft.chance(0.3)) return;
  draft.note("bend");
  const double rate = kTwoPi / (columns * random.between(2.0, 3.0));
  sheet.folds.push_back({Vector2d(rate, 0.0),
                         random.between(0.0, kTwoPi),
                         random.between(0.05, 0.2) / rate * Vector2d(0.3, 1.0),
                         0.05});
}

void make_room(Draft& draft) {
  Random& random = draft.random;
  draft.look(0.05 * draft.wild.width, random.between(0.2, 1.2), kFacing, 0.3);
  draft.ground(draft.chance(0.5) ? GroundKind::kTiles : GroundKind::kPlain,
               random.between(60.0, 190.0),
               0.6);
  Sheet& wall = draft.sheet(upright_frame({0.0, 9.0, 0.0}, 1.0, kFacing));
  wall.shapes.push_back(
      box({0.0, -10.0}, {40.0, 10.0}, 0.0, draft.paint(random.between(80.0, 220.0), 3.0, 1.0)));
  for (int i = 0; i < 4; ++i) {
    wall.shapes.push_back(box({random.between(-9.0, 9.0), random.between(-8.0, -3.0)},
                              {random.between(0.5, 2.0), random.between(0.5, 2.0)},
                              0.0,
                              draft.paint(random.between(20.0, 240.0), 15.0, 2.0)));
  }
  draft.boxes(6 + random.below(8), 2.0, 2.5);
  Sheet& desk = draft.sheet(level_frame(
      {random.between(-4.0, 4.0), random.between(-3.0, 3.0), 1.5}, 1.0, random.between(0.0, 3.0)));
  desk.shapes.push_back(
      box({0.0, 0.0}, {4.0, 2.0}, 0.0, draft.paint(random.between(80.0, 220.0), 8.0, 0.7)));
  for (int i = 0; i < 5; ++i) {
    desk.shapes.push_back(box({random.between(-3.0, 3.0), random.between(-1.2, 1.2)},
                              {random.between(0.2, 0.9), random.between(0.2, 0.6)},
                              random.between(0.0, 3.0),
                              draft.paint(random.between(15.0, 245.0), 12.0, 6.0),
                              draft.chance(0.4) ? 0.08 : 0.0));
  }
  draft.note("room");
}

// A balloon: an egg on a string, its blunt end up.
Shape balloon(Draft& draft, Sheet& sheet, const Paint& paint) {
  sheet.shapes.push_back(
      stroke({0.0, 0.9}, {draft.random.between(-0.4, 0.4), 3.0}, 0.03, draft.paint(60.0)));
  Shape body = disc({0.0, 0.0}, 1.0, paint);
  body.outline = Outline::kEgg;
  body.amount = draft.random.between(0.04, 0.13);
  body.sheet_from_shape.rotate(-0.5 * std::numbers::pi);
  const Vector3d sun = paint.lit_from;
  body.paint.lit_from = {-sun.y(), sun.x(), sun.z()};
  return body;
}

// @param sun  Unit; as Paint::lit_from.
void add_ball(Draft& draft, const Vector3d& on_ground, double size, const Vector3d& sun) {
  Random& random = draft.random;
  const double grey = random.between(30.0, 240.0);
  const bool is_balloon = draft.chance(0.35);
  Vector3d at = on_ground;
  if (is_balloon) at.z() += random.between(0.5, 3.0);
  draft.note(is_balloon ? "balloon" : "ball");
  Sheet& sheet =
      draft.sheet(is_balloon ? upright_frame(at, size, kFacing) : level_frame(at, 1.0, 0.0));
  if (!is_balloon) sheet.ball_radius = size;
  sheet.swing = {Vector3d(random.between(-1.0, 1.0), 0.0, 0.0),
                 random.between(2.0, 8.0),
                 random.between(0.0, kTwoPi)};
  Paint paint = draft.paint(grey, 4.0);
  paint.lit_from = sun;
  Shape body = is_balloon ? balloon(draft, sheet, paint) : disc({0.0, 0.0}, 1.0, paint);
  body.is_listed = body.is_target = true;
  sheet.shapes.push_back(body);
  Shape shine = blot({0.5 * sun.x(), 0.5 * sun.y()}, 0.14, draft.paint(250.0), draft.seed());
  shine.softness = 0.4;
  shine.paint.opacity = 0.7;
  sheet.shapes.push_back(shine);
  if (!draft.chance(0.3)) return;
  const Vector2d stripe(0.0, random.between(-0.4, 0.4));
  sheet.shapes.push_back(
      box(stripe, {0.8, 0.1}, random.between(-0.5, 0.5), draft.paint(255.0 - grey)));
}

void make_surface(Draft& draft) {
  constexpr std::array kKinds = {GroundKind::kGravel,
                                 GroundKind::kPavement,
                                 GroundKind::kFoliage,
                                 GroundKind::kPage,
                                 GroundKind::kField,
                                 GroundKind::kGrass,
                                 GroundKind::kRoad,
                                 GroundKind::kSquares,
                                 GroundKind::kRounded,
                                 GroundKind::kFlowers,
                                 GroundKind::kClutter};
  constexpr std::array kNames = {"gravel",
                                 "pavement",
                                 "foliage",
                                 "text",
                                 "field",
                                 "grass",
                                 "arcs",
                                 "squares",
                                 "rounded-square",
                                 "flowers",
                                 "clutter"};
  const auto kind = static_cast<std::size_t>(draft.random.below(kKinds.size()));
  draft.note(kNames[kind]);
  draft.look(draft.wild.width * draft.log_between(0.04, 0.3),
             std::acos(draft.random.between(0.25, 1.0)),
             draft.random.between(-2.2, -0.9));
  draft.ground(kKinds[kind], draft.random.between(50.0, 200.0), draft.log_between(0.3, 1.8));
}

}  // namespace

void make_board(Draft& draft) {
  Random& random = draft.random;
  draft.note("board");
  const int columns = 4 + random.below(8);
  const int rows = 3 + random.below(6);
  const double unit_px = draft.wild.width * random.between(0.5, 1.1) / columns;
  draft.look(unit_px, random.between(0.0, 0.9), random.between(-2.0, -1.1), 0.4);
  draft.scene().flight.highest = draft.scene().flight.lowest * 1.2;
  Greys greys = draft.greys();
  if (greys.paint > greys.around && draft.chance(0.7)) std::swap(greys.paint, greys.around);
  draft.ground(
      draft.chance(0.7) ? GroundKind::kSkin : GroundKind::kPage, random.between(50.0, 200.0), 0.5);
  draft.weather();
  add_board(draft, {0.0, 0.0}, columns, rows, greys);
  if (draft.chance(0.4)) add_board(draft, {columns + 1.5, 0.0}, columns, rows, greys);
  if (draft.chance(0.2)) draft.limb();
  if (draft.chance(0.2)) draft.shadow();
}

void make_balls(Draft& draft) {
  Random& random = draft.random;
  const double tilt = random.between(0.3, 1.35);
  draft.look(draft.wild.width * draft.log_between(0.03, 0.2), tilt, kFacing, 0.3);
  draft.scene().flight.reach *= 0.4;
  draft.ground(draft.chance(0.5) ? GroundKind::kGrass : GroundKind::kTiles,
               random.between(50.0, 190.0),
               draft.log_between(0.2, 1.3));
  draft.weather();
  if (draft.chance(0.5)) draft.boxes(4, 3.0, 1.0);
  const Vector3d sun(
      random.between(-0.8, 0.8), random.between(-0.9, 0.0), random.between(0.1, 0.8));
  const int count = 1 + random.below(3);
  for (int i = 0; i < count; ++i) {
    const double size = i + 1 == count ? 1.0 : random.between(0.5, 1.0);
    add_ball(draft, {3.0 * i, random.between(-1.0, 1.0), size}, size, sun.normalized());
  }
  if (draft.chance(0.2)) draft.limb();
  if (draft.chance(0.2)) draft.netting();
}

void make_cut(Draft& draft) {
  Random& random = draft.random;
  draft.note("cut");
  const double radius_px = draft.wild.width * random.between(0.25, 0.8);
  const double tilt = std::acos(random.between(0.3, 1.0));
  draft.look(radius_px, tilt, random.between(-2.4, -0.7), 0.9);
  draft.scene().flight.highest = draft.scene().flight.lowest * 1.1;
  draft.defocus(radius_px * std::cos(tilt));
  const Greys greys = draft.greys();
  constexpr std::array kKinds = {
      GroundKind::kPlain, GroundKind::kSkin, GroundKind::kAsphalt, GroundKind::kGrass};
  draft.ground(kKinds[static_cast<std::size_t>(random.below(kKinds.size()))],
               greys.around,
               draft.log_between(0.1, 1.0));
  draft.weather();
  Sheet& sheet = draft.sheet(level_frame({0.0, 0.0, 0.0}, 1.0, 0.0));
  Shape plate = disc({0.0, 0.0}, 1.0, draft.paint(greys.paint, 6.0, 3.0));
  plate.is_listed = plate.is_target = true;
  if (draft.chance(0.4)) plate.hole = random.between(0.6, 0.95);
  sheet.shapes.push_back(plate);
  if (draft.chance(0.25)) draft.shadow();
  if (draft.chance(0.25)) draft.limb();
  if (draft.chance(0.15)) draft.netting();
}

void make_textures(Draft& draft) {
  const int kind = draft.random.below(10);
  if (kind == 0) return make_eye(draft, true);
  if (kind <= 2) return make_traffic(draft, false);
  if (kind <= 4) {
    make_room(draft);
  } else {
    make_surface(draft);
  }
  draft.weather();
  if (draft.chance(0.4)) draft.boxes(2 + draft.random.below(8), 1.5, 1.0);
  if (draft.chance(0.25)) draft.shadow();
  if (draft.chance(0.25)) draft.people(2.0, 2.9, draft.scene().flight.azimuth_rad);
  if (draft.chance(0.2)) draft.limb();
  if (draft.chance(0.4)) draft.netting();
  if (draft.chance(0.15)) draft.cable();
}

}  // namespace ellipse::wild
