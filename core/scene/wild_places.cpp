// SPDX-License-Identifier: MIT
//
// Wild scenes of boards, roads, balls, large ellipses, and of places without any ellipse.
#include <algorithm>
#include <array>
#include <numbers>

#include "core/scene/wild_draft.hpp"

namespace ellipse::wild {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kFacing = -0.5 * std::numbers::pi;  // azimuth from which the horizon is level

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

struct Vehicle {
  double length = 4.2;
  double height = 1.45;
  double wheel = 0.32;    // radius
  double at_front = 1.3;  // of the wheels' axles, from the middle
};

// Seen from its side. One unit is a metre.
void add_vehicle(Draft& draft, Sheet& sheet, const Vehicle& car) {
  Random& random = draft.random;
  const double grey = random.between(20.0, 230.0);
  const double half = 0.5 * car.length;
  const Paint body = draft.paint(grey, 6.0, 3.0);
  const Paint dark = draft.paint(random.between(10.0, 40.0));
  const double belt = -0.6 * car.height;
  const Paint glass = draft.paint(random.between(20.0, 140.0), 5.0);
  sheet.shapes.push_back(polygon(
      {{-half, -0.25}, {-half, belt}, {half * 0.9, belt}, {half, 0.8 * belt}, {half, -0.25}},
      body,
      0.06));
  sheet.shapes.push_back(polygon({{-0.75 * half, belt},
                                  {-0.5 * half, -car.height},
                                  {0.3 * half, -car.height},
                                  {0.6 * half, belt}},
                                 glass,
                                 0.05));
  for (const double x : {-car.at_front, car.at_front}) {
    draft.note("wheel");
    // The body's arch lies around the wheel: a box, that nothing round is there but the wheel.
    sheet.shapes.push_back(box({x, -0.3}, {1.25 * car.wheel, 0.32}, 0.0, dark));
    Shape tyre = disc({x, -car.wheel}, car.wheel, draft.paint(random.between(45.0, 80.0)));
    Shape rim = disc({x, -car.wheel}, 0.65 * car.wheel, draft.paint(random.between(110.0, 220.0)));
    tyre.is_listed = rim.is_listed = true;
    tyre.is_target = true;
    sheet.shapes.push_back(tyre);
    sheet.shapes.push_back(rim);
    std::vector<Shape> spokes = glyph('X', 0.25, draft.paint(40.0));
    place(spokes, {x, -car.wheel}, 0.4 * car.wheel, random.between(0.0, kTwoPi));
    sheet.shapes.insert(sheet.shapes.end(), spokes.begin(), spokes.end());
  }
}

// Seen from its front: lamps.
void add_front(Draft& draft, Sheet& sheet) {
  Random& random = draft.random;
  const Paint body = draft.paint(random.between(20.0, 200.0), 6.0, 3.0);
  sheet.shapes.push_back(box({0.0, -0.7}, {0.9, 0.45}, 0.0, body, 0.1));
  sheet.shapes.push_back(polygon({{-0.8, -1.1}, {-0.6, -1.6}, {0.6, -1.6}, {0.8, -1.1}},
                                 draft.paint(random.between(20.0, 120.0), 5.0)));
  sheet.shapes.push_back(box({0.0, -0.55}, {0.4, 0.1}, 0.0, draft.paint(20.0)));
  for (const double x : {-0.65, 0.65}) {
    draft.note("lamp");
    Shape lamp = disc({x, -0.75}, 0.14, draft.paint(random.between(225.0, 254.0)));
    lamp.is_listed = lamp.is_target = true;
    sheet.shapes.push_back(lamp);
    sheet.shapes.push_back(box({x, -0.15}, {0.12, 0.15}, 0.0, draft.paint(25.0)));
  }
}

void add_sign(Draft& draft, Sheet& sheet, bool is_round) {
  Random& random = draft.random;
  sheet.shapes.push_back(
      stroke({0.0, 0.0}, {0.0, -2.2}, 0.08, draft.paint(random.between(60.0, 150.0))));
  const Greys greys = draft.greys();
  std::vector<Shape> sign;
  if (is_round) {
    draft.note("sign");
    Shape rim = disc({0.0, 0.0}, 1.0, draft.paint(greys.paint));
    Shape face = disc({0.0, 0.0}, random.between(0.7, 0.85), draft.paint(greys.around));
    rim.is_listed = face.is_listed = rim.is_target = true;
    sign = {rim, face};
  } else {
    draft.note("polygon");
    const int corners = draft.chance(0.5) ? 8 : 3;
    sign = {polygon(regular_corners(corners, std::numbers::pi / (corners == 8 ? 8.0 : 6.0)),
                    draft.paint(greys.paint)),
            polygon(regular_corners(corners, std::numbers::pi / (corners == 8 ? 8.0 : 6.0)),
                    draft.paint(greys.around))};
    sign.back().place.scale(0.75);
  }
  std::vector<Shape> mark =
      glyph(static_cast<char>('1' + 3 * random.below(3)), 0.25, draft.paint(greys.paint));
  place(mark, {0.0, 0.0}, 0.35, 0.0);
  sign.insert(sign.end(), mark.begin(), mark.end());
  place(sign, {0.0, -2.2}, 0.4, 0.0);
  sheet.shapes.insert(sheet.shapes.end(), sign.begin(), sign.end());
}

void add_hills(Draft& draft) {
  Sheet& hills = draft.sheet(upright_frame({0.0, 60.0, 0.0}, 1.0, kFacing));
  std::vector<Vector2d> outline{{120.0, 5.0}, {-120.0, 5.0}};
  for (double x = -120.0; x <= 120.0; x += 6.0) {
    outline.emplace_back(x, -draft.random.between(2.0, 9.0));
  }
  hills.shapes.push_back(
      polygon(outline, draft.paint(draft.random.between(40.0, 130.0), 20.0, 1.0)));
  draft.note("foliage");
}

void add_markings(Draft& draft) {
  Sheet& road = draft.sheet(level_frame({0.0, 0.0, 0.0}, 1.0, draft.random.between(-0.5, 0.5)));
  const Paint white = draft.paint(draft.random.between(150.0, 240.0), 6.0);
  road.shapes.push_back(
      box({0.0, 0.0}, {3.5, 90.0}, 0.0, draft.paint(draft.random.between(60.0, 130.0), 8.0, 3.0)));
  for (const double x : {-3.2, 3.2}) road.shapes.push_back(box({x, 0.0}, {0.09, 90.0}, 0.0, white));
  for (int i = -6; i < 12; ++i) road.shapes.push_back(box({0.0, 5.0 * i}, {0.08, 1.3}, 0.0, white));
}

// A camera at a person's or a vehicle's height.
void look_along(Draft& draft, double unit_px) {
  draft.look(unit_px, draft.random.between(1.15, 1.4), kFacing, 0.0);
  Flight& flight = draft.scene().flight;
  flight.reach *= 0.25;
  flight.roll_rad *= 0.3;
  flight.aim = {draft.random.between(-1.5, 1.5), 0.0, draft.random.between(0.0, 1.5)};
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

void make_traffic(Draft& draft, bool has_round_things) {
  Random& random = draft.random;
  draft.note("traffic");
  look_along(draft, draft.wild.width * draft.log_between(0.06, 0.22));
  draft.ground(draft.chance(0.5) ? GroundKind::kField : GroundKind::kGrass,
               random.between(60.0, 170.0),
               0.8);
  draft.weather();
  add_hills(draft);
  add_markings(draft);
  for (int i = 1 + random.below(3); i > 0; --i) {
    const double turn = kFacing + random.between(-0.7, 0.7);
    const Vector3d at(random.between(-5.0, 5.0), 3.0 * i - 3.0 + random.between(-1.0, 1.0), 0.0);
    Sheet& sheet = draft.sheet(upright_frame(at, 1.0, turn));
    sheet.swing = {Vector3d(random.between(-2.0, 2.0), 0.0, 0.0),
                   random.between(4.0, 9.0),
                   random.between(0.0, kTwoPi)};
    const int kind = random.below(3);
    if (!has_round_things || kind == 2) {
      add_sign(draft, sheet, has_round_things);
    } else if (kind == 1) {
      add_front(draft, sheet);
    } else {
      add_vehicle(draft, sheet, {});
    }
  }
  if (draft.chance(0.3)) draft.people(3.0, 1.75, kFacing);
  if (draft.chance(0.15)) draft.netting();
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
  const Vector3d sun =
      Vector3d(random.between(-0.8, 0.8), random.between(-0.9, 0.0), random.between(0.1, 0.8))
          .normalized();
  for (int i = 1 + random.below(3), x = 0; i > 0; --i, x += 3) {
    const double size = i == 1 ? 1.0 : random.between(0.5, 1.0);
    const double y = random.between(-1.0, 1.0);
    const double grey = random.between(30.0, 240.0);
    const bool is_balloon = draft.chance(0.35);
    Vector3d at(x, y, size);
    if (is_balloon) at.z() += random.between(0.5, 3.0);
    draft.note(is_balloon ? "balloon" : "ball");
    Sheet& sheet =
        draft.sheet(is_balloon ? upright_frame(at, size, kFacing) : level_frame(at, 1.0, 0.0));
    if (!is_balloon) sheet.ball_radius = size;
    sheet.swing = {Vector3d(random.between(-1.0, 1.0), 0.0, 0.0),
                   random.between(2.0, 8.0),
                   random.between(0.0, kTwoPi)};
    Shape body = disc({0.0, 0.0}, 1.0, draft.paint(grey, 4.0));
    body.paint.lit_from = sun;
    body.is_listed = body.is_target = true;
    if (is_balloon) {
      sheet.shapes.push_back(
          stroke({0.0, 0.9}, {random.between(-0.4, 0.4), 3.0}, 0.03, draft.paint(60.0)));
      body.outline = Outline::kEgg;
      body.amount = random.between(0.04, 0.13);
      body.place.rotate(-0.5 * std::numbers::pi);
      body.paint.lit_from = Vector3d(-sun.y(), sun.x(), sun.z());
    }
    sheet.shapes.push_back(body);
    Shape shine = blot({0.5 * sun.x(), 0.5 * sun.y()}, 0.14, draft.paint(250.0), draft.seed());
    shine.softness = 0.4;
    shine.paint.opacity = 0.7;
    sheet.shapes.push_back(shine);
    if (draft.chance(0.3)) {
      sheet.shapes.push_back(box({0.0, random.between(-0.4, 0.4)},
                                 {0.8, 0.1},
                                 random.between(-0.5, 0.5),
                                 draft.paint(255.0 - grey)));
    }
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
