#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "core/camera/camera.hpp"
#include "core/detection/detectors.hpp"
#include "core/detection/evidence.hpp"
#include "core/detection/thresholds.hpp"
#include "core/image/roi.hpp"
#include "core/tracking/pad/refinement.hpp"

namespace ellipse {

enum class TrackingMode {
  kNone,      ///< Independent detection in every frame.
  kRedetect,  ///< [Keipour2021] Algorithm 2: lowered thresholds, region of interest, frame scale.
  kEdges,     ///< Learned edges of the pad, searched along their normals from the predicted view.
};

/// All parameters of a tracker. A value.
struct TrackerSettings {
  DetectorKind detector = DetectorKind::kArcs;
  TrackingMode tracking = TrackingMode::kEdges;
  Refinement refine = Refinement::kEdges;  ///< Of the ellipse during edge tracking.
  Overlaps detect_overlaps = {};           ///< Each 0 = the detector's own.
  Overlaps track_overlaps = {};            ///< Each 0 = the detector's own.
  Thresholds limits = {};  ///< All other thresholds; the overlaps above replace its own.
  EvidenceTable evidence = built_in_evidence();  ///< For the detector `arcs`.
  double min_target_size_px = 40.0;   ///< minTargetSize: full axis at the processed scale.
  double max_target_size_px = 120.0;  ///< maxTargetSize: full axis at the processed scale.
  int max_scale = 100;                ///< maxScale: coarsest frame scale, 1 to 128.
  bool wants_candidates = false;      ///< All ellipses of every frame, also during edge tracking.
  double roi_expansion =
      kRoiExpansion;                  ///< Margin of the ROI: (this - 1) semi-major axes; 1 to 10.
  double ring_ratio = 0.0;            ///< Inner over outer radius of the pad's ring; 0 = learned.
  std::optional<Camera> camera = {};  ///< From a file; overrides the numbers below.
  double hfov_rad = 0.0;              ///< Horizontal field of view of a pinhole; 0 = unknown.
  double fx_px = 0.0;                 ///< Focal length of a pinhole; overrides hfov_rad.
  double fy_px = 0.0;                 ///< 0 = as fx.
  double cx_px = 0.0;                 ///< Principal point; 0 = image centre.
  double cy_px = 0.0;
  double target_diameter_m = 0.0;   ///< Of the outer circle; 0 = unknown.
  std::array<double, 3> gravity{};  ///< Downwards in the camera frame, for a level target; or 0.

  /// Throws std::invalid_argument that names the field.
  void validate() const;

  /// The camera for frames of this size; nullopt if none is known.
  [[nodiscard]] std::optional<Camera> camera_for(int width, int height) const;

  bool operator==(const TrackerSettings&) const = default;
};

/// Detector and tracking with which a setting has an effect; see core/tracking/setting_effect.hpp.
struct SettingEffect {
  std::optional<DetectorKind> detector = {};  ///< Required detector; nullopt = any.
  std::optional<TrackingMode> tracking = {};  ///< Required tracking; nullopt = any.
  const char* otherwise = "";    ///< Element property that lifts these conditions, or empty.
  double elsewhere_above = 0.0;  ///< Min effective value with another detector; 0 = never.
};

/// Description of one numeric setting for user interfaces.
struct SettingInfo {
  const char* name;         ///< In kebab-case; also the name of the element's property.
  const char* description;  ///< A phrase with the unit, without a full stop.
  SettingEffect effect;
  Range range;
  bool is_integer;
  bool is_controllable;  ///< May be animated over time.
  double (*get)(const TrackerSettings&);
  void (*set)(TrackerSettings&, double);
};

/// All numeric settings.
[[nodiscard]] std::span<const SettingInfo> setting_infos();

/// The effect of a setting: a numeric one, "detector", "tracking", "refine" or "candidates".
/// Throws std::invalid_argument for an unknown name.
[[nodiscard]] SettingEffect effect_of(std::string_view name);

/// The nicks of the tracking modes, in enum order.
[[nodiscard]] std::span<const char* const> tracking_nicks();

/// Sets one setting by name from text: a number, a nick, or a file for "evidence-file".
/// Throws std::invalid_argument that names the setting if the name or the value is invalid.
void set_by_name(TrackerSettings& settings, std::string_view name, std::string_view value);

}  // namespace ellipse
