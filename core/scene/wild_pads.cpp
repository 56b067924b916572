// SPDX-License-Identifier: MIT
//
// Wild scenes of landing pads, and of polygons that resemble one.
#include <array>
#include <numbers>

#include "core/scene/wild_draft.hpp"

namespace ellipse::wild {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::array kGrounds = {GroundKind::kAsphalt,
                                 GroundKind::kGrass,
                                 GroundKind::kRoad,
                                 GroundKind::kTiles,
                                 GroundKind::kGravel,
                                 GroundKind::kPavement,
                                 GroundKind::kFoliage,
                                 GroundKind::kField,
                                 GroundKind::kPlain,
                                 GroundKind::kSkin,
                                 GroundKind::kPage};

void lay_ground(Draft& draft, double grey) {
  const GroundKind kind = kGrounds[static_cast<std::size_t>(draft.random.below(kGrounds.size()))];
  draft.ground(kind, grey, draft.log_between(0.2, 1.5));
  if (kind == GroundKind::kGravel) draft.note("gravel");
  if (kind == GroundKind::kPavement) draft.note("pavement");
  if (kind == GroundKind::kFoliage) draft.note("foliage");
  if (kind == GroundKind::kPage) draft.note("text");
}

void listed(Shape& shape, bool is_target) {
  shape.is_listed = true;
  shape.is_target = is_target;
}

// Makes the pad's outlines slightly noncircular, still close to an ellipse.
void distort(Draft& draft, std::vector<Shape>& shapes, std::size_t from) {
  if (!draft.chance(0.14)) return;
  const bool is_egg = draft.chance(0.4);
  const double power = 2.0 + draft.sign() * draft.random.between(0.1, 0.3);
  const double egg = draft.random.between(0.04, 0.12);
  for (std::size_t i = from; i < shapes.size(); ++i) {
    Shape& shape = shapes[i];
    if (shape.outline != Outline::kEllipse) continue;
    shape.outline = is_egg ? Outline::kEgg : Outline::kSuperellipse;
    shape.amount = is_egg ? egg : power;
  }
  draft.note(is_egg ? "egg" : "superellipse");
}

// @param is_needed  For a pad that does not lie on the ground.
void add_plate(Draft& draft, Sheet& sheet, double around, bool is_needed) {
  if (!is_needed && draft.chance(0.2)) return;
  const double rim = draft.random.between(15.0, 240.0);
  const double size = draft.random.between(1.12, 1.7);
  if (draft.chance(0.25)) {
    draft.note("round-plate");
    Shape plate = disc({0.0, 0.0}, size, draft.paint(around, 3.0, 4.0));
    listed(plate, false);
    sheet.shapes.push_back(plate);
    return;
  }
  draft.note("square-plate");
  const Vector2d half(size, size * draft.random.between(1.0, 1.3));
  if (draft.chance(0.6)) {
    sheet.shapes.push_back(box({0.0, 0.0}, 1.12 * half, 0.0, draft.paint(rim, 3.0)));
  }
  sheet.shapes.push_back(box({0.0, 0.0}, half, 0.0, draft.paint(around, 3.0, 4.0)));
}

void add_ring(Draft& draft, Sheet& sheet, const Greys& greys) {
  const double width = draft.log_between(0.03, 0.4);
  Shape ring = disc({0.0, 0.0}, 1.0, draft.paint(greys.paint, 3.0));
  ring.hole = 1.0 - width;
  listed(ring, true);
  draft.note(width < 0.08 ? "thin-ring" : "ring");
  sheet.shapes.push_back(ring);
  const double room = 0.8 * ring.hole;
  const double bar = draft.random.between(0.06, 0.4);
  const Paint paint = draft.paint(draft.chance(0.8) ? greys.paint : greys.around);
  std::vector<Shape> mark;
  const int kind = draft.random.below(4);
  if (kind == 0) {
    draft.note("x");
    mark = glyph('X', bar, paint);
  } else if (kind == 1) {
    draft.note("h");
    mark = glyph('H', bar, paint);
  } else if (kind == 2) {
    draft.note("number");
    mark = glyph(static_cast<char>('0' + draft.random.below(10)), bar, paint);
    std::vector<Shape> second = glyph(static_cast<char>('0' + draft.random.below(10)), bar, paint);
    place(mark, {-0.85, 0.0}, 0.7, 0.0);
    place(second, {0.85, 0.0}, 0.7, 0.0);
    mark.insert(mark.end(), second.begin(), second.end());
  }
  place(mark, {0.0, 0.0}, 0.6 * room, draft.random.between(0.0, kTwoPi));
  sheet.shapes.insert(sheet.shapes.end(), mark.begin(), mark.end());
}

void add_bullseye(Draft& draft, Sheet& sheet, const Greys& greys) {
  draft.note("bullseye");
  double radius = 1.0;
  for (int i = 2 + draft.random.below(3); i > 0 && radius > 0.12; --i) {
    Shape ring = disc({0.0, 0.0}, radius, draft.paint(greys.paint, 3.0));
    ring.hole = i > 1 ? draft.random.between(0.6, 0.85) : 0.0;
    listed(ring, radius == 1.0);
    sheet.shapes.push_back(ring);
    radius *= ring.hole * draft.random.between(0.55, 0.8);
  }
}

void add_disc(Draft& draft, Sheet& sheet, const Greys& greys) {
  draft.note("disc");
  Shape shape = disc({0.0, 0.0}, 1.0, draft.paint(greys.paint, 3.0));
  if (draft.chance(0.3)) {
    draft.note("soft-edge");
    shape.softness = draft.log_between(0.02, 0.12);
  }
  listed(shape, true);
  sheet.shapes.push_back(shape);
}

// Glints and dirt on the edge.
void add_glints(Draft& draft, Sheet& sheet) {
  if (!draft.chance(0.3)) return;
  draft.note("glint");
  for (int i = 1 + draft.random.below(4); i > 0; --i) {
    const double angle = draft.random.between(0.0, kTwoPi);
    const double grey = draft.chance(0.6) ? 252.0 : draft.random.between(10.0, 240.0);
    Shape glint = blot(draft.random.between(0.8, 1.1) * Vector2d(std::cos(angle), std::sin(angle)),
                       draft.log_between(0.04, 0.35),
                       draft.paint(grey),
                       draft.seed());
    glint.softness = draft.random.between(0.05, 0.5);
    glint.paint.opacity = draft.random.between(0.4, 1.0);
    sheet.shapes.push_back(glint);
  }
}

void deform(Draft& draft, Sheet& sheet) {
  if (!draft.chance(0.35)) return;
  const bool is_cloth = draft.chance(0.6);
  draft.note(is_cloth ? "folds" : "bend");
  // Largest slope of the displacement: below one half in total.
  double room = is_cloth ? draft.random.between(0.06, 0.3) : draft.random.between(0.08, 0.2);
  for (int i = is_cloth ? 2 + draft.random.below(3) : 1; i > 0; --i) {
    const double length =
        is_cloth ? draft.random.between(0.7, 3.0) : draft.random.between(5.0, 9.0);
    const double angle = draft.random.between(0.0, kTwoPi);
    const double rate = kTwoPi / length;
    const double part = room * draft.random.between(0.3, 0.7);
    room -= part;
    const double turn = draft.random.between(0.0, kTwoPi);
    sheet.folds.push_back({rate * Vector2d(std::cos(angle), std::sin(angle)),
                           draft.random.between(0.0, kTwoPi),
                           part / rate * Vector2d(std::cos(turn), std::sin(turn)),
                           is_cloth ? draft.random.between(0.0, 0.15) : 0.0});
  }
}

void add_pad(Draft& draft, const Vector3d& at, double scale, const Greys& greys) {
  Sheet& sheet = draft.sheet(level_frame(at, scale, draft.random.between(0.0, kTwoPi)));
  add_plate(draft, sheet, greys.around, at.z() > 0.0);
  const std::size_t first = sheet.shapes.size();
  const double kind = draft.random.unit();
  if (kind < 0.55) {
    add_ring(draft, sheet, greys);
  } else if (kind < 0.75) {
    add_bullseye(draft, sheet, greys);
  } else {
    add_disc(draft, sheet, greys);
  }
  distort(draft, sheet.shapes, first);
  add_glints(draft, sheet);
  deform(draft, sheet);
}

// Something that carries the pad: a dark body with struts.
void add_carrier(Draft& draft) {
  Sheet& body = draft.sheet(level_frame({0.0, 0.0, 0.0}, 1.0, draft.random.between(0.0, kTwoPi)));
  const Paint dark = draft.paint(draft.random.between(12.0, 60.0), 10.0, 6.0);
  body.shapes.push_back(box({0.4, 0.3}, {1.5, 1.1}, 0.0, dark));
  for (int i = 0; i < 6; ++i) {
    const double angle = draft.random.between(0.0, kTwoPi);
    const Vector2d out(std::cos(angle), std::sin(angle));
    const Paint strut = draft.paint(draft.random.between(15.0, 235.0));
    body.shapes.push_back(stroke(out, draft.random.between(1.9, 2.8) * out, 0.07, strut));
  }
}

void add_occluders(Draft& draft, double azimuth_rad) {
  if (draft.chance(0.25)) draft.shadow();
  if (draft.chance(0.2)) draft.people(draft.random.between(1.4, 2.6), 2.9, azimuth_rad);
  if (draft.chance(0.12)) draft.limb();
  if (draft.chance(0.1)) draft.cable();
  if (draft.chance(0.12)) draft.netting();
}

// Keeps corners visible: the sides of a polygon are inside its circle by more than the blur.
int max_corners(double radius_px, double blur_px) {
  int corners = 12;
  while (corners > 5 &&
         radius_px * (1.0 - std::cos(std::numbers::pi / corners)) < 1.5 + 1.5 * blur_px) {
    --corners;
  }
  return corners;
}

}  // namespace

void make_pads(Draft& draft) {
  const double tilt = std::acos(draft.random.between(0.3, 1.0));
  const double azimuth = draft.random.between(-2.2, -0.9);
  const double radius_px = draft.wild.width * draft.log_between(0.03, 0.35);
  draft.look(radius_px, tilt, azimuth);
  draft.defocus(radius_px * std::cos(tilt));
  const Greys greys = draft.greys();
  lay_ground(draft, draft.random.between(30.0, 210.0));
  draft.weather();
  if (draft.chance(0.3)) draft.boxes(2 + draft.random.below(6), 2.5, 1.0);
  const bool is_carried = draft.chance(0.25);
  if (is_carried) add_carrier(draft);
  add_pad(draft, {0.0, 0.0, is_carried ? draft.random.between(0.3, 1.0) : 0.0}, 1.0, greys);
  if (draft.chance(0.15)) {
    draft.note("several-pads");
    double angle = draft.random.between(0.0, kTwoPi);
    for (int i = 1 + draft.random.below(2); i > 0; --i, angle += kTwoPi / 3.0) {
      const Vector2d at =
          draft.random.between(4.2, 6.0) * Vector2d(std::cos(angle), std::sin(angle));
      add_pad(draft, {at.x(), at.y(), 0.0}, draft.random.between(0.5, 1.0), greys);
    }
  }
  add_occluders(draft, azimuth);
}

void make_polygons(Draft& draft) {
  const double tilt = std::acos(draft.random.between(0.35, 1.0));
  const double azimuth = draft.random.between(-2.2, -0.9);
  const double radius_px = draft.wild.width * draft.log_between(0.06, 0.35);
  draft.look(radius_px, tilt, azimuth);
  const Greys greys = draft.greys();
  lay_ground(draft, draft.random.between(30.0, 210.0));
  draft.weather();
  if (draft.chance(0.5)) draft.boxes(2 + draft.random.below(6), 2.5, 1.0);
  Sheet& sheet = draft.sheet(level_frame({0.0, 0.0, 0.0}, 1.0, draft.random.between(0.0, kTwoPi)));
  if (draft.chance(0.6)) {
    sheet.shapes.push_back(box({0.0, 0.0}, {1.4, 1.6}, 0.3, draft.paint(greys.around, 3.0)));
  }
  const bool is_square = draft.chance(0.3);
  draft.note(is_square ? "rounded-square" : "polygon");
  const double corner_limit =
      max_corners(radius_px * std::cos(tilt) * 0.75, draft.scene().sensor.blur_px);
  const auto corners = regular_corners(5 + draft.random.below(static_cast<int>(corner_limit) - 4),
                                       draft.random.between(0.0, kTwoPi));
  const double rounding = draft.random.between(0.0, 0.35);
  double grey = greys.paint;
  double size = 1.0;
  while (size > 0.6) {
    Shape shape = is_square ? box({0.0, 0.0}, {0.9, 0.9}, 0.0, draft.paint(grey, 3.0), rounding)
                            : polygon(corners, draft.paint(grey, 3.0));
    shape.sheet_from_shape = Eigen::Scaling(size) * shape.sheet_from_shape;
    sheet.shapes.push_back(shape);
    grey = greys.paint + greys.around - grey;
    if (draft.chance(0.4)) break;
    size *= draft.random.between(0.8, 0.95);
  }
  std::vector<Shape> mark =
      glyph(draft.chance(0.7) ? 'H' : 'X', draft.random.between(0.15, 0.4), draft.paint(grey));
  place(mark, {0.0, 0.0}, 0.38, draft.random.between(0.0, kTwoPi));
  sheet.shapes.insert(sheet.shapes.end(), mark.begin(), mark.end());
  deform(draft, sheet);
  add_occluders(draft, azimuth);
}

}  // namespace ellipse::wild
