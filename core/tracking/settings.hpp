#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "core/camera/camera.hpp"
#include "core/detection/detectors.hpp"
#include "core/detection/evidence.hpp"
#include "core/detection/thresholds.hpp"
#include "core/tracking/pad/refinement.hpp"

namespace ellipse {

enum class TrackingMode {
  kNone,      ///< Every frame by itself, the whole of it, at scale 1.
  kRedetect,  ///< [Keipour2021] Algorithm 2: lowered thresholds, region of interest, frame scale.
  kEdges,     ///< The learned edges of the pad, along their normals from the predicted view.
};

/// Every tunable of a tracker. A value: copy it, change it, hand it over.
struct TrackerSettings {
  DetectorKind detector = DetectorKind::kArcs;
  TrackingMode tracking = TrackingMode::kEdges;
  Refinement refine = Refinement::kEdges;  ///< Of the ellipse while its edges are followed.
  Overlaps detect_overlaps = {};           ///< Each 0 = the detector's own.
  Overlaps track_overlaps = {};            ///< Each 0 = the detector's own.
  Thresholds limits = {};  ///< All else; its two overlaps are replaced by those above.
  EvidenceTable evidence = built_in_evidence();  ///< Of the detector `arcs`.
  double min_target_size_px = 40.0;   ///< minTargetSize: full axis at the processed scale.
  double max_target_size_px = 120.0;  ///< maxTargetSize: full axis at the processed scale.
  int max_scale = 100;                ///< maxScale: coarsest frame scale, 1 to 128.
  bool wants_candidates = false;      ///< All ellipses of every frame, also while following edges.
  double roi_expansion = 2.0;         ///< Margin of the ROI: (this - 1) semi-major axes; 1 to 10.
  double ring_ratio = 0.0;            ///< Inner over outer radius of the pad's ring; 0 = learned.
  std::optional<Camera> camera = {};  ///< From a file; goes before the numbers below.
  double hfov_rad = 0.0;              ///< Horizontal field of view of a pinhole; 0 = not known.
  double fx_px = 0.0;                 ///< Focal length of a pinhole; goes before the field of view.
  double fy_px = 0.0;                 ///< 0 = as fx.
  double cx_px = 0.0;                 ///< Principal point; 0 = the picture's middle.
  double cy_px = 0.0;
  double target_diameter_m = 0.0;   ///< Of the outer circle; 0 = not known.
  std::array<double, 3> gravity{};  ///< Down in the camera's frame, for a level target; or 0.

  /// Throws std::invalid_argument that names the field.
  void validate() const;

  /// The camera for frames of this size; nullopt where none is known.
  [[nodiscard]] std::optional<Camera> camera_for(int width, int height) const;

  bool operator==(const TrackerSettings&) const = default;
};

/// With which detector and tracking a setting changes any result; see
/// core/tracking/setting_effect.hpp.
struct SettingEffect {
  std::optional<DetectorKind> detector = {};  ///< With this one only; nullopt = with any.
  std::optional<TrackingMode> tracking = {};  ///< With this one only; nullopt = with any.
  const char* otherwise = "";  ///< A property of the element that makes it act everywhere; or none.
  double elsewhere_above = 0.0;  ///< With another detector, above this value only; 0 = never.
};

/// One number among the settings, as programs offer it to people.
struct SettingInfo {
  const char* name;         ///< In kebab-case; also the name of the element's property.
  const char* description;  ///< A sentence with the unit.
  SettingEffect effect;
  Range range;
  bool is_integer;
  bool is_controllable;  ///< May follow a curve over time.
  double (*get)(const TrackerSettings&);
  void (*set)(TrackerSettings&, double);
};

/// All of them, in the order in which [Keipour2021] speaks of them.
[[nodiscard]] std::span<const SettingInfo> setting_infos();

/// The effect of any setting: one of these numbers, "detector", "tracking", "refine" or
/// "candidates". Throws std::invalid_argument where the name is none of them.
[[nodiscard]] SettingEffect effect_of(std::string_view name);

/// The nicks of the tracking modes, in their order.
[[nodiscard]] std::span<const char* const> tracking_nicks();

/// Sets one setting by name from text: a number, or a nick for "detector", "tracking", "refine".
/// Throws std::invalid_argument that names the setting where it is unknown, or the value no good.
void set_by_name(TrackerSettings& settings, std::string_view name, std::string_view value);

}  // namespace ellipse
