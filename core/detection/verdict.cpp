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
    {"no-ellipse", "no ellipse fits its points", "", "", ""},
    {"too-small", "too small", "minor axis", "px", "min-axis"},
    {"too-large", "too large", "major axis", "px", "max-axis"},
    {"too-flat", "too flat", "axis ratio", "", "max-axis-ratio"},
    {"contour-overlap", "contour overlap too low", "share", "", "contour-overlap"},
    {"ellipse-overlap", "ellipse overlap too low", "share", "", "ellipse-overlap"},
    {"known", "duplicate of another ellipse", "", "", ""},
    {"crowded-out", "too many better ellipses", "", "", ""},
    {"poor-fit", "its arcs do not fit one ellipse", "RMS distance", "px", ""},
    {"far-outside", "its centre is far outside the frame", "distance in frame sizes", "", ""},
    {"cut", "reaches beyond the searched region", "", "", ""},
    {"duplicate-of-rejected", "duplicate of a rejected ellipse", "", "", ""},
    {"too-few-edges", "too few edges along its outline", "edges", "", ""},
    {"unlikely", "its edges do not support an ellipse", "probability", "", "min-probability"},
    {"too-far-from-last", "too far from the last target", "distance", "px", ""},
    {"other-size", "size differs from the last target", "major axis", "px", ""},
    {"single", "no second concentric edge, unlike the best set", "", "", ""},
    {"weaker-set", "another set has more evidence", "score", "", ""},
    {"weak-in-set", "little evidence compared with its set", "score", "", ""},
    {"inner-edge", "inside the target", "major axis", "px", ""},
    {"same-edge", "other side of the target's edge", "score", "", ""},
};
static_assert(std::size(kInfos) == static_cast<std::size_t>(Reason::kSameEdge) + 1);

}  // namespace

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
