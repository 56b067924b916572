// SPDX-License-Identifier: MIT
#include "core/tracking/settings.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "core/edges/thin_ring.hpp"

namespace ellipse {
namespace {

constexpr Range kMaxScaleRange{1.0, 128.0};
constexpr Range kRoiExpansionRange{1.0, 10.0};
constexpr Range kRingRatioRange{0.0, kMaxRingRatio};
constexpr Range kFieldOfViewRange{0.0, 3.0};
constexpr Range kFocalRangePx{0.0, kFarPx};
constexpr Range kCoordinateRangePx{-kFarPx, kFarPx};
constexpr Range kDiameterRange{0.0, 1e4};

template <auto kMember, auto... kRest>
constexpr auto& follow(auto& object) {
  if constexpr (sizeof...(kRest) == 0) {
    return object.*kMember;
  } else {
    return follow<kRest...>(object.*kMember);
  }
}

// The setting at the end of a path of members.
template <auto... kPath>
constexpr SettingInfo setting(const char* name,
                              const Range& range,
                              bool is_controllable,
                              const char* description,
                              const SettingEffect& effect = {}) {
  using Field = std::remove_cvref_t<decltype(follow<kPath...>(std::declval<TrackerSettings&>()))>;
  return {
      name,
      description,
      effect,
      range,
      std::is_integral_v<Field>,
      is_controllable,
      [](const TrackerSettings& s) { return static_cast<double>(follow<kPath...>(s)); },
      [](TrackerSettings& s, double value) { follow<kPath...>(s) = static_cast<Field>(value); }};
}

constexpr auto kDetect = &TrackerSettings::detect_overlaps;
constexpr auto kTrack = &TrackerSettings::track_overlaps;
constexpr auto kLimits = &TrackerSettings::limits;

// Lower bound on the contour overlap of ellipses reported by `arcs`: thresholds below it reject
// none. The lowest of 333 ellipses (all scenes of the catalog, one frame per second) is .953;
// the bound leaves a margin of .3.
constexpr double kMinOnEllipse = 0.65;

// Tests compare each effect with the tracker's behaviour.
constexpr SettingEffect kOfContours{.detector = DetectorKind::kContours,
                                    .elsewhere_above = kMinOnEllipse};
constexpr SettingEffect kOfArcs{.detector = DetectorKind::kArcs};
constexpr SettingEffect kOfRedetect{.tracking = TrackingMode::kRedetect};
constexpr SettingEffect kOfContoursRedetect{.detector = DetectorKind::kContours,
                                            .tracking = TrackingMode::kRedetect,
                                            .elsewhere_above = kMinOnEllipse};
constexpr SettingEffect kOfScale{.tracking = TrackingMode::kRedetect,
                                 .otherwise = "max-processing-time"};
constexpr SettingEffect kOfEdges{.tracking = TrackingMode::kEdges};

const std::array kSettings = {
    setting<kDetect, &Overlaps::contour>(
        "detect-contour-overlap",
        kShareRange,
        true,
        "When detecting, minimum share of a contour's pixels on its ellipse; 0 = detector default",
        kOfContours),
    setting<kDetect, &Overlaps::ellipse>(
        "detect-ellipse-overlap",
        kShareRange,
        true,
        "When detecting, minimum share of an ellipse's perimeter on edges; 0 = detector default"),
    setting<kTrack, &Overlaps::contour>(
        "track-contour-overlap",
        kShareRange,
        true,
        "When tracking, minimum share of a contour's pixels on its ellipse; 0 = detector default",
        kOfContoursRedetect),
    setting<kTrack, &Overlaps::ellipse>(
        "track-ellipse-overlap",
        kShareRange,
        true,
        "When tracking, minimum share of an ellipse's perimeter on edges; 0 = detector default",
        kOfRedetect),
    setting<kLimits, &Thresholds::min_axis_px>(
        "min-axis", kAxisRangePx, true, "Minimum minor axis, full length [px]"),
    setting<kLimits, &Thresholds::max_axis_px>(
        "max-axis", kAxisRangePx, true, "Maximum major axis, full length [px]"),
    setting<kLimits, &Thresholds::max_axis_ratio>(
        "max-axis-ratio", kAxisRatioRange, true, "Maximum ratio of major to minor axis"),
    setting<kLimits, &Thresholds::min_probability>(
        "min-probability",
        kShareRange,
        true,
        "Minimum probability of an ellipse; for a target followed with tracking=edges, values "
        "above 0.993 act as 0.993",
        kOfArcs),
    setting<kLimits, &Thresholds::min_contour_size>(
        "min-contour-size", kContourSizeRangePx, true, "Minimum contour length [px]"),
    setting<&TrackerSettings::max_scale>(
        "max-scale", kMaxScaleRange, false, "Maximum factor by which a frame is reduced", kOfScale),
    setting<&TrackerSettings::min_target_size_px>(
        "min-target-size",
        kAxisRangePx,
        true,
        "Minimum full major axis at the processed scale [px]; below it the scale gets finer",
        kOfRedetect),
    setting<&TrackerSettings::max_target_size_px>(
        "max-target-size",
        kAxisRangePx,
        true,
        "Maximum full major axis at the processed scale [px]; above it the scale gets coarser",
        kOfRedetect),
    setting<&TrackerSettings::roi_expansion>(
        "roi-expansion",
        kRoiExpansionRange,
        true,
        "Search region: the target's box plus (value - 1) semi-major axes on each side",
        kOfRedetect),
    setting<&TrackerSettings::ring_ratio>(
        "ring-ratio",
        kRingRatioRange,
        false,
        "Ratio of inner to outer radius of the target's ring; 0 = learned",
        kOfEdges),
    setting<&TrackerSettings::hfov_rad>(
        "hfov",
        kFieldOfViewRange,
        false,
        "Horizontal field of view of a lens without distortion [rad]; 0 = unknown"),
    setting<&TrackerSettings::fx_px>(
        "fx",
        kFocalRangePx,
        false,
        "Focal length of a lens without distortion [px]; overrides hfov; 0 = unknown"),
    setting<&TrackerSettings::fy_px>(
        "fy", kFocalRangePx, false, "Vertical focal length, with fx [px]; 0 = same as fx"),
    setting<&TrackerSettings::cx_px>(
        "cx", kCoordinateRangePx, false, "Principal point x, with fx [px]; 0 = frame centre"),
    setting<&TrackerSettings::cy_px>(
        "cy", kCoordinateRangePx, false, "Principal point y, with fx [px]; 0 = frame centre"),
    setting<&TrackerSettings::target_diameter_m>(
        "target-diameter",
        kDiameterRange,
        false,
        "Diameter of the target's outer edge [m], for its position; 0 = unknown"),
    setting<kLimits, &Thresholds::edge_low>(
        "edge-low",
        kEdgeRange,
        true,
        "Lower edge threshold [grey levels per px]; 0 = adapted to the frame"),
    setting<kLimits, &Thresholds::edge_high>(
        "edge-high",
        kEdgeRange,
        true,
        "Upper edge threshold [grey levels per px]; 0 = adapted to the frame"),
};

const SettingInfo& info_named(std::string_view name) {
  const auto found = std::find_if(
      kSettings.begin(), kSettings.end(), [&](const SettingInfo& i) { return name == i.name; });
  if (found != kSettings.end()) return *found;
  throw std::invalid_argument("unknown property \"" + std::string(name) + "\"");
}

constexpr const char* kTrackingNicks[] = {"none", "redetect", "edges"};

template <class Enum>
Enum from_nick(std::string_view name, std::string_view nick, std::span<const char* const> nicks) {
  const auto found = std::find(nicks.begin(), nicks.end(), nick);
  if (found != nicks.end()) return static_cast<Enum>(found - nicks.begin());
  std::string message = std::string(name) + " = \"" + std::string(nick) + "\" is not one of:";
  for (const char* each : nicks) message += std::string(" ") + each;
  throw std::invalid_argument(message);
}

double number(std::string_view name, std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size()) return value;
  throw std::invalid_argument(std::string(name) + " = \"" + std::string(text) +
                              "\" is not a number");
}

}  // namespace

void TrackerSettings::validate() const {
  for (const SettingInfo& info : kSettings) check_range(info.name, info.get(*this), info.range);
  // Focal lengths in units of the picture's width are a common mistake.
  if (fx_px != 0.0) check_range("fx", fx_px, {1.0, kFocalRangePx.max});
  if (fy_px != 0.0) check_range("fy", fy_px, {1.0, kFocalRangePx.max});
  check_order("min-axis", limits.min_axis_px, "max-axis", limits.max_axis_px);
  if (limits.edge_high > 0.0) {
    check_order("edge-low", limits.edge_low, "edge-high", limits.edge_high);
  }
  check_order("min-target-size", min_target_size_px, "max-target-size", max_target_size_px);
  if (camera) camera->validate();
  for (const double g : gravity) {
    if (!std::isfinite(g)) throw std::invalid_argument("gravity is not finite");
  }
}

std::optional<Camera> TrackerSettings::camera_for(int width, int height) const {
  if (camera) return camera->resized(width, height);
  if (!(fx_px > 0.0) && !(hfov_rad > 0.0)) return std::nullopt;
  Camera pinhole = Camera::with_hfov(hfov_rad, width, height);
  if (fx_px > 0.0) {
    pinhole.fx = fx_px;
    pinhole.fy = fy_px > 0.0 ? fy_px : fx_px;
    if (cx_px != 0.0) pinhole.cx = cx_px;
    if (cy_px != 0.0) pinhole.cy = cy_px;
  }
  return pinhole;
}

std::span<const SettingInfo> setting_infos() {
  return kSettings;
}

SettingEffect effect_of(std::string_view name) {
  if (name == "refine") return kOfEdges;
  if (name == "detector" || name == "tracking" || name == "candidates") return {};
  return info_named(name).effect;
}

std::span<const char* const> tracking_nicks() {
  return kTrackingNicks;
}

void set_by_name(TrackerSettings& settings, std::string_view name, std::string_view value) {
  if (name == "detector") {
    settings.detector = from_nick<DetectorKind>(name, value, detector_nicks());
    return;
  }
  if (name == "tracking") {
    settings.tracking = from_nick<TrackingMode>(name, value, kTrackingNicks);
    return;
  }
  if (name == "refine") {
    settings.refine = from_nick<Refinement>(name, value, refinement_nicks());
    return;
  }
  if (name == "evidence-file") {
    settings.evidence = value.empty() ? built_in_evidence() : read_evidence(value);
    return;
  }
  const SettingInfo& found = info_named(name);
  const double parsed = number(name, value);
  check_range(found.name, parsed, found.range);
  if (found.is_integer && parsed != std::floor(parsed)) {
    throw std::invalid_argument(std::string(name) + " = " + std::string(value) +
                                " is not a whole number");
  }
  found.set(settings, parsed);
}

}  // namespace ellipse
