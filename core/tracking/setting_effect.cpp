// SPDX-License-Identifier: MIT
#include "core/tracking/setting_effect.hpp"

#include <sstream>

namespace ellipse {

Acts acts_with(const SettingEffect& effect, DetectorKind detector, TrackingMode tracking) {
  if (effect.tracking.value_or(tracking) != tracking) return Acts::kNever;
  if (effect.detector.value_or(detector) == detector) return Acts::kAlways;
  return effect.elsewhere_above > 0.0 ? Acts::kAbove : Acts::kNever;
}

std::string condition_of(const SettingEffect& effect) {
  std::string text;
  const auto add = [&text](const std::string& part) {
    text += (text.empty() ? "with " : " and ") + part;
  };
  if (effect.detector) {
    add(std::string("detector=") + detector_nicks()[static_cast<std::size_t>(*effect.detector)]);
  }
  if (effect.tracking) {
    add(std::string("tracking=") + tracking_nicks()[static_cast<std::size_t>(*effect.tracking)]);
  }
  if (text.empty()) return text;
  const std::string otherwise = effect.otherwise;
  if (!otherwise.empty()) return text + ", or together with " + otherwise;
  if (effect.elsewhere_above == 0.0) return text + " only";
  std::ostringstream above;
  above << "; with another detector above " << effect.elsewhere_above << " only";
  return text + above.str();
}

std::string blurb_of(const std::string& description, const SettingEffect& effect) {
  const std::string condition = condition_of(effect);
  return condition.empty() ? description : description + "; acts " + condition;
}

TrackerSettings in_force(const TrackerSettings& settings) {
  TrackerSettings result = settings;
  const auto detector = make_detector(settings.detector);
  result.detect_overlaps = settings.detect_overlaps.or_own(detector->detecting_overlaps());
  result.track_overlaps = settings.track_overlaps.or_own(detector->tracking_overlaps());
  if (result.fy_px == 0.0) result.fy_px = settings.fx_px;
  return result;
}

}  // namespace ellipse
