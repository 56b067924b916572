#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "core/tracking/settings.hpp"

namespace ellipse {

/// Which values of a setting change any result.
enum class Acts {
  kNever,
  kAbove,  ///< Those above SettingEffect::elsewhere_above.
  kAlways,
};

/// What a setting does with this detector and this tracking, as long as the property
/// SettingEffect::otherwise has its default.
[[nodiscard]] Acts acts_with(const SettingEffect& effect,
                             DetectorKind detector,
                             TrackingMode tracking);

/// When it acts, as a clause: "with detector=contours and tracking=redetect only". Empty where it
/// always does.
[[nodiscard]] std::string condition_of(const SettingEffect& effect);

/// A description with the condition behind it: the blurb of the property.
[[nodiscard]] std::string blurb_of(const std::string& description, const SettingEffect& effect);

/// The settings with each 0 that stands for another known value replaced by it: the detector's own
/// overlaps; fx for fy.
[[nodiscard]] TrackerSettings in_force(const TrackerSettings& settings);

}  // namespace ellipse
