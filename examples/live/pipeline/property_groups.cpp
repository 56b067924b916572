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
    Group{"detector", "detector"},
    Group{"detect-", "detector"},
    Group{"edge-", "detector"},
    Group{"min-probability", "detector"},
    Group{"candidates", "detector"},
    Group{"tracking", "tracker"},
    Group{"track-", "tracker"},
    Group{"refine", "tracker"},
    Group{"ring-ratio", "tracker"},
    Group{"roi-expansion", "tracker"},
    Group{"min-axis", "limits"},
    Group{"max-axis", "limits"},
    Group{"min-contour-size", "limits"},
    Group{"roi", "search region"},
    Group{"max-scale", "scale"},
    Group{"min-target-size", "scale"},
    Group{"max-target-size", "scale"},
    Group{"camera-", "lens and pose"},
    Group{"hfov", "lens and pose"},
    Group{"fx", "lens and pose"},
    Group{"fy", "lens and pose"},
    Group{"cx", "lens and pose"},
    Group{"cy", "lens and pose"},
    Group{"target-diameter", "lens and pose"},
    Group{"gravity", "lens and pose"},
    Group{"messages", "output"},
    Group{"attach-", "output"},
    Group{"overlay", "output"},
    Group{"line-width", "output"},
    Group{"interval", "performance"},
    Group{"max-processing-time", "performance"},
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
