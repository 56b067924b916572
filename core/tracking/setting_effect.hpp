#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "core/tracking/settings.hpp"

namespace ellipse {

/// Which values of a setting have an effect.
enum class Acts {
  kNever,
  kAbove,  ///< Those above SettingEffect::elsewhere_above.
  kAlways,
};

/// Whether a setting has an effect with this detector and tracking, while the property
/// SettingEffect::otherwise has its default.
[[nodiscard]] Acts acts_with(const SettingEffect& effect,
                             DetectorKind detector,
                             TrackingMode tracking);

/// The condition as a clause: "with detector=contours and tracking=redetect only". Empty if the
/// setting always has an effect.
[[nodiscard]] std::string condition_of(const SettingEffect& effect);

/// The property's blurb: the description followed by the condition.
[[nodiscard]] std::string blurb_of(const std::string& description, const SettingEffect& effect);

/// Replaces each 0 that stands for a default: overlaps by the detector's own, fy by fx. Allocates:
/// creates the detector.
[[nodiscard]] TrackerSettings in_force(const TrackerSettings& settings);

}  // namespace ellipse
