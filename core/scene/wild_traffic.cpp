// SPDX-License-Identifier: MIT
//
// Wild scenes of roads. One unit is a metre.
#include <numbers>

#include "core/scene/wild_draft.hpp"

namespace ellipse::wild {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

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
    // The wheel arch is a box, so that only the wheel is round.
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
    sign.back().sheet_from_shape.scale(0.75);
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
  for (int x = -120; x <= 120; x += 6) {
    outline.emplace_back(static_cast<double>(x), -draft.random.between(2.0, 9.0));
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

}  // namespace

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

}  // namespace ellipse::wild
