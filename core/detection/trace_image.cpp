// SPDX-License-Identifier: MIT
#include "core/detection/trace_image.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/image/scale.hpp"

namespace ellipse {
namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr Color kGrey = {84, 90, 98};
constexpr Color kFound = {255, 196, 64};
constexpr Color kTarget = {72, 230, 140};
constexpr Color kRejectedColor = {232, 88, 96};

// Hues a golden angle apart: consecutive indices have clearly different colours.
Color color_of(std::size_t i) {
  const double hue = static_cast<double>(i) * std::numbers::pi * (3.0 - std::sqrt(5.0));
  Color color;
  for (std::size_t k = 0; k < 3; ++k) {
    const double phase = hue + static_cast<double>(k) * 2.0 * std::numbers::pi / 3.0;
    color[k] = static_cast<std::uint8_t>(165.0 + 85.0 * std::cos(phase));
  }
  return color;
}

class Sheet {
 public:
  explicit Sheet(const TracedPass& pass) : pass_(pass) {
    picture_ = {pass.width, pass.height, {}};
    picture_.pixels.assign(3 * pass.luma.size(), 0);
  }

  void put(int x, int y, const Color& color) {
    if (x < 0 || y < 0 || x >= picture_.width || y >= picture_.height) return;
    const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) +
                    static_cast<std::size_t>(x);
    for (std::size_t k = 0; k < 3; ++k) picture_.pixels[3 * at + k] = color[k];
  }

  void draw_gray(const std::vector<std::uint8_t>& gray, int dimmed_by = 1) {
    for (std::size_t i = 0; i < picture_.pixels.size(); ++i) {
      picture_.pixels[i] = static_cast<std::uint8_t>(gray[i / 3] / dimmed_by);
    }
  }

  void draw_piece(const TracedPiece& piece, const Color& color) {
    for (std::size_t i = piece.begin; i < piece.end; ++i) {
      put(pass_.points[i].x, pass_.points[i].y, color);
    }
  }

  void draw_ellipse(const Ellipse& e, const Color& color) {
    walk_perimeter(to_region(e, pass_.region, pass_.scale), [&](const PerimeterStep& step) {
      put(static_cast<int>(std::lround(step.point.x())),
          static_cast<int>(std::lround(step.point.y())),
          color);
    });
  }

  [[nodiscard]] RgbPicture take() { return std::move(picture_); }

 private:
  const TracedPass& pass_;
  RgbPicture picture_;
};

void draw_pieces(Sheet& sheet, std::span<const TracedPiece> pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) sheet.draw_piece(pieces[i], color_of(i));
}

// Draws rejected candidates first, so that found ones cover them.
void draw_candidates(Sheet& sheet, const DetectionTrace& trace, std::size_t pass) {
  const auto draw = [&](const Color& color, const auto& counts) {
    for (const TracedCandidate& candidate : trace.candidates()) {
      if (candidate.pass == pass && candidate.ellipse && counts(candidate)) {
        sheet.draw_ellipse(*candidate.ellipse, color);
      }
    }
  };
  draw(kRejectedColor, [](const TracedCandidate& c) { return !c.is_detection; });
  draw(kFound, [](const TracedCandidate& c) { return c.is_detection && !c.is_target; });
  draw(kTarget, [](const TracedCandidate& c) { return c.is_target; });
}

void draw_short_contours(Sheet& sheet, const DetectionTrace& trace, std::size_t pass) {
  for (const TracedCandidate& candidate : trace.candidates()) {
    const bool is_contour = candidate.pass == pass && !candidate.ellipse &&
                            candidate.verdict.reason == Reason::kContourTooShort;
    if (!is_contour) continue;
    for (const TracedPiece& piece : candidate.pieces) sheet.draw_piece(piece, kGrey);
  }
}

}  // namespace

std::span<const char* const> stage_nicks() {
  static constexpr const char* kNicks[] = {"luma", "edges", "chains", "arcs", "candidates"};
  return kNicks;
}

RgbPicture draw_stage(const DetectionTrace& trace, std::size_t number, Stage stage) {
  if (number >= trace.passes().size()) return {};
  const TracedPass& pass = trace.passes()[number];
  Sheet sheet(pass);
  switch (stage) {
    case Stage::kLuma:
      sheet.draw_gray(pass.luma);
      break;
    case Stage::kEdges:
      sheet.draw_gray(pass.edges);
      break;
    case Stage::kChains:
      draw_pieces(sheet, pass.chains);
      draw_short_contours(sheet, trace, number);
      break;
    case Stage::kArcs:
      for (const TracedPiece& chain : pass.chains) sheet.draw_piece(chain, kGrey);
      draw_pieces(sheet, pass.arcs);
      break;
    case Stage::kCandidates:
      sheet.draw_gray(pass.luma, 3);
      draw_candidates(sheet, trace, number);
      break;
  }
  return sheet.take();
}

}  // namespace ellipse
