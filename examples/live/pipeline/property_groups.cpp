// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/property_groups.hpp"

#include <array>

namespace live {
namespace {

struct Group {
  std::string_view start;  // prefix of the property name
  std::string_view name;
};

// The first match applies.
constexpr std::array kGroups = {
    Group{"detector", "detection"},
    Group{"detect-", "detection"},
    Group{"min-axis", "detection"},
    Group{"max-axis", "detection"},
    Group{"min-contour-size", "detection"},
    Group{"min-probability", "detection"},
    Group{"candidates", "detection"},
    Group{"tracking", "tracking"},
    Group{"track-", "tracking"},
    Group{"refine", "tracking"},
    Group{"ring-ratio", "tracking"},
    Group{"max-scale", "scale"},
    Group{"min-target-size", "scale"},
    Group{"max-target-size", "scale"},
    Group{"roi", "ROI"},
    Group{"edge-", "edges"},
    Group{"camera-", "camera"},
    Group{"hfov", "camera"},
    Group{"fx", "camera"},
    Group{"fy", "camera"},
    Group{"cx", "camera"},
    Group{"cy", "camera"},
    Group{"target-diameter", "camera"},
    Group{"gravity", "camera"},
    Group{"interval", "load"},
    Group{"max-processing-time", "load"},
    Group{"qos", "load"},
    Group{"messages", "output"},
    Group{"attach-", "output"},
    Group{"overlay", "output"},
    Group{"line-width", "output"},
};

constexpr std::array<std::string_view, 3> kUnits = {"[grey levels per px]", "[px]", "[ns]"};

}  // namespace

std::string_view group_of(std::string_view property) {
  for (const Group& group : kGroups) {
    if (property.starts_with(group.start)) return group.name;
  }
  return "other";
}

std::string_view unit_in(std::string_view blurb) {
  for (const std::string_view unit : kUnits) {
    if (blurb.find(unit) != std::string_view::npos) return unit.substr(1, unit.size() - 2);
  }
  return "";
}

}  // namespace live
