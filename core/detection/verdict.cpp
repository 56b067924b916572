// SPDX-License-Identifier: MIT
#include "core/detection/verdict.hpp"

#include <cstddef>
#include <iterator>
#include <sstream>

namespace ellipse {
namespace {

constexpr ReasonInfo kInfos[] = {
    {"accepted", "accepted", "", "", ""},
    {"contour-too-short", "contour too short", "length", "px", "min-contour-size"},
    {"no-ellipse", "no ellipse goes through its points", "", "", ""},
    {"too-small", "too small", "minor axis", "px", "min-axis"},
    {"too-large", "too large", "major axis", "px", "max-axis"},
    {"too-flat", "too flat", "axis ratio", "", "max-axis-ratio"},
    {"contour-overlap", "ContourOverlap too low", "share", "", "contour-overlap"},
    {"ellipse-overlap", "EllipseOverlap too low", "share", "", "ellipse-overlap"},
    {"known", "the same as another that was found", "", "", ""},
    {"crowded-out", "too many that are better", "", "", ""},
    {"poor-fit", "its arcs are not of one ellipse", "RMS distance", "px", ""},
    {"far-outside", "its centre is far outside", "distance in pictures", "", ""},
    {"refused", "the same as another that was refused", "", "", ""},
    {"too-few-edges", "too few edges along it", "edges", "", ""},
    {"unlikely", "its edges are not those of an ellipse", "probability", "", "min-probability"},
    {"other-place", "not where the target was", "distance", "px", ""},
    {"other-size", "not of the size that the target was", "major axis", "px", ""},
    {"single", "alone, while there are concentric ones", "", "", ""},
    {"weaker-set", "another set has more evidence", "score", "", ""},
    {"weak-in-set", "little evidence beside its set", "score", "", ""},
    {"inner-edge", "inside of the target", "major axis", "px", ""},
    {"same-edge", "the other side of the target's edge", "score", "", ""},
};
static_assert(std::size(kInfos) == static_cast<std::size_t>(Reason::kSameEdge) + 1);

}  // namespace

std::span<const ReasonInfo> reason_infos() {
  return kInfos;
}

const ReasonInfo& reason_info(Reason reason) {
  return kInfos[static_cast<std::size_t>(reason)];
}

std::string to_text(const Verdict& verdict) {
  const ReasonInfo& info = reason_info(verdict.reason);
  std::ostringstream text;
  text.precision(3);
  text << info.description;
  if (*info.quantity == '\0') return text.str();
  const char* space = *info.unit == '\0' ? "" : " ";
  const char* bound = verdict.measured < verdict.limit ? "at least " : "at most ";
  text << ": " << info.quantity << ' ' << verdict.measured << space << info.unit << ", " << bound
       << verdict.limit;
  return text.str();
}

}  // namespace ellipse
