// SPDX-License-Identifier: MIT
//
// Clutter and occluders for any wild scene.

#include "core/scene/wild_draft.hpp"

namespace ellipse::wild {

using Eigen::Vector2d;
using Eigen::Vector3d;

void Draft::limb() {
  note("hand");
  Sheet& arm = picture_sheet();
  const double aspect = static_cast<double>(wild.height) / wild.width;
  const double angle = random.between(0.0, kTwoPi);
  const Vector2d from = 0.75 * Vector2d(std::cos(angle), std::sin(angle));
  const Vector2d to(random.between(-0.35, 0.35), aspect * random.between(-0.35, 0.35));
  const Vector2d along = (to - from).normalized();
  const Vector2d across(-along.y(), along.x());
  const double width = log_between(0.02, 0.09);
  const double grey = random.between(30.0, 220.0);
  const Paint skin = paint(grey, 12.0, random.between(10.0, 40.0));
  arm.defocus_px = chance(0.3) ? random.between(0.5, 3.0) : 0.0;
  arm.swing = {0.06 * Vector3d(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.0),
               random.between(1.5, 6.0),
               random.between(0.0, kTwoPi)};
  arm.shapes.push_back(polygon({from - 1.6 * width * across,
                                from + 1.6 * width * across,
                                to + width * across,
                                to - width * across},
                               skin));
  // The hand: a palm and fingers, none of them round.
  const Vector2d palm = to + width * along;
  arm.shapes.push_back(
      box(palm, {1.2 * width, 1.1 * width}, std::atan2(along.y(), along.x()), skin, 0.3 * width));
  for (int finger = -1; finger <= 2; ++finger) {
    const Vector2d root = palm + width * along + (0.55 * finger - 0.25) * width * across;
    const Vector2d tip = root + width * random.between(0.7, 1.6) * along +
                         width * random.between(-0.4, 0.4) * across;
    arm.shapes.push_back(stroke(root, tip, 0.42 * width, skin));
  }
}

void Draft::netting() {
  const double grey = random.between(10.0, 245.0);
  const int kind = random.below(3);
  Sheet& net = picture_sheet();
  net.defocus_px = chance(0.5) ? random.between(0.0, 3.0) : 0.0;
  net.swing.reach = {random.between(-0.02, 0.02), random.between(-0.02, 0.02), 0.0};
  if (kind == 2) {
    note("fence");
    const double spacing = random.between(0.08, 0.25);
    const double width = spacing * random.between(0.06, 0.25);
    double x = -0.6;
    while (x < 0.6) {
      net.shapes.push_back(stroke({x, -0.6}, {x + 0.03, 0.6}, width, paint(grey, 8.0)));
      x += spacing;
    }
    for (const double y : {random.between(-0.3, -0.1), random.between(0.1, 0.3)}) {
      net.shapes.push_back(stroke({-0.7, y}, {0.7, y + 0.04}, width, paint(grey, 8.0)));
    }
    return;
  }
  note(kind == 0 ? "mesh" : "net");
  const double spacing = log_between(0.02, 0.14);
  const double shear = kind == 0 ? random.between(-0.1, 0.1) : random.between(0.4, 0.8) * sign();
  Shape wires = mesh(spacing, spacing * random.between(0.05, 0.16), shear, paint(grey));
  wires.sheet_from_shape.prerotate(random.between(0.0, kTwoPi));
  net.shapes.push_back(wires);
  if (chance(0.6)) {
    net.folds.push_back({Vector2d(random.between(-6.0, 6.0), random.between(-6.0, 6.0)),
                         random.between(0.0, kTwoPi),
                         0.02 * Vector2d(random.between(-1.0, 1.0), random.between(-1.0, 1.0)),
                         0.0});
  }
}

void Draft::cable() {
  note("cable");
  Sheet& cables = picture_sheet();
  cables.swing = {{0.0, random.between(-0.1, 0.1), 0.0}, random.between(2.0, 8.0), 0.0, 1};
  const Paint tone = paint(random.between(10.0, 245.0));
  for (int i = 1 + random.below(3); i > 0; --i) {
    const double y = random.between(-0.3, 0.3);
    cables.shapes.push_back(
        stroke({-0.6, y}, {0.6, y + random.between(-0.4, 0.4)}, log_between(0.003, 0.03), tone));
  }
}

void Draft::shadow() {
  note("shadow");
  Sheet& ground = sheet(level_frame({0.0, 0.0, 0.0}, 1.0, random.between(0.0, kTwoPi)));
  Paint dark;
  dark.level = 0.0;
  dark.opacity = random.between(0.2, 0.49);
  const int kind = random.below(3);
  Shape shade;
  if (kind == 0) {  // the edge of a house
    shade = box({8.0 + random.between(-0.9, 0.9), 0.0}, {8.0, 30.0}, 0.0, dark);
  } else if (kind == 1) {  // a mast, or a leg
    shade = box({random.between(-1.0, 1.0), 0.0}, {random.between(0.05, 0.5), 30.0}, 0.0, dark);
  } else {  // a tree, or a vehicle
    shade = blot({random.between(-1.5, 1.5), random.between(-1.5, 1.5)},
                 random.between(0.5, 2.0),
                 dark,
                 seed());
  }
  shade.softness = log_between(0.005, 0.15);
  ground.shapes.push_back(shade);
}

void Draft::people(double distance, double height, double azimuth_rad) {
  note("person");
  for (int i = 1 + random.below(4); i > 0; --i) {
    const double angle = random.between(0.0, kTwoPi);
    const Vector2d at =
        distance * random.between(1.0, 1.7) * Vector2d(std::cos(angle), std::sin(angle));
    Sheet& person = sheet(upright_frame({at.x(), at.y(), 0.0}, height, azimuth_rad));
    person.swing.reach =
        0.05 * distance * Vector3d(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.0);
    const Paint trousers = paint(random.between(20.0, 120.0), 10.0, 30.0);
    const Paint shirt = paint(random.between(20.0, 230.0), 10.0, 20.0);
    const Paint skin = paint(random.between(70.0, 190.0), 6.0);
    const double lean = random.between(-0.1, 0.1);
    person.shapes.push_back(stroke({-0.08, -0.03}, {lean - 0.05, -0.48}, 0.1, trousers));
    person.shapes.push_back(stroke({0.09, -0.03}, {lean + 0.05, -0.48}, 0.1, trousers));
    person.shapes.push_back(box({1.3 * lean, -0.64}, {0.12, 0.19}, 0.0, shirt, 0.05));
    for (const double side : {-1.0, 1.0}) {
      const Vector2d hand(1.3 * lean + side * random.between(0.15, 0.35),
                          random.between(-0.7, -0.3));
      person.shapes.push_back(stroke({1.3 * lean + 0.12 * side, -0.78}, hand, 0.06, shirt));
      person.shapes.push_back(stroke(hand, hand + Vector2d(0.03 * side, 0.03), 0.05, skin));
    }
    // A head with hair or a cap, which together are not an ellipse.
    const Vector2d head(1.5 * lean, -0.91);
    person.shapes.push_back(box(head, {0.055, 0.075}, 0.0, skin, 0.03));
    person.shapes.push_back(box(
        head - Vector2d(0.01, 0.06), {0.075, 0.03}, 0.0, paint(random.between(10.0, 230.0)), 0.01));
  }
}

void Draft::boxes(int count, double reach, double size) {
  Sheet& things = sheet(level_frame({0.0, 0.0, 0.0}, 1.0, 0.0));
  for (int i = 0; i < count; ++i) {
    const double angle = random.between(0.0, kTwoPi);
    const Vector2d at =
        reach * random.between(1.0, 2.0) * Vector2d(std::cos(angle), std::sin(angle));
    const double width = size * random.between(0.2, 1.0);
    const double turn = random.between(0.0, kTwoPi);
    const double grey = random.between(15.0, 240.0);
    const Vector2d half(width, width * random.between(0.3, 1.0));
    things.shapes.push_back(box(at, half, turn, paint(grey, 8.0)));
    if (chance(0.5)) {
      things.shapes.push_back(box(at, 0.7 * half, turn, paint(255.0 - grey, 8.0)));
    }
  }
}

}  // namespace ellipse::wild
