#pragma once  // SPDX-License-Identifier: MIT

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <span>

namespace ellipse {

/// ln(p / (1 - p)). Finite for 0 and 1 too, so that sums are: -27.6 and 27.6.
[[nodiscard]] inline double log_odds(double probability) {
  const double p = std::clamp(probability, 1e-12, 1.0 - 1e-12);
  return std::log(p / (1.0 - p));
}

/// ln(p / (1 - p)) = log_odds.
[[nodiscard]] inline double probability_of(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

/// What is measured along a candidate's outline. Each is a number that grows or falls with the
/// odds of an ellipse.
enum class Feature : std::size_t {
  kTurnSupport,  ///< Share of the outline's turn inside the picture that has edges on it, 0 to 1.
  kDirectionError,  ///< ln of the median angle between the gradient and the normal [rad].
  kCoverage,        ///< ln of turn support x (1 - longest part of the perimeter without an edge).
  kLength,          ///< ln(1 + length of the outline inside the picture) [px].
  kDeviation,       ///< ln of the RMS distance of the edges from the outline [radii].
  kRadius,          ///< ln of the radius sqrt(ab) [px].
  kContrast,        ///< ln of the mean gradient over the noise.
  kStraight,        ///< Share of edges that do not turn with the outline, 0 to 1.
};
inline constexpr std::size_t kFeatures = 8;

using Features = std::array<double, kFeatures>;

/// A feature as programs show it to people.
struct FeatureInfo {
  const char* nick;         ///< In kebab-case.
  const char* description;  ///< A noun phrase.
};

/// Valid for ever; thread-safe.
[[nodiscard]] std::span<const FeatureInfo, kFeatures> feature_infos();

/// Logistic regression: the log odds of an ellipse are bias + sum of weight x (feature - mean).
struct EvidenceTable {
  Features weights{};
  Features means{};  ///< Of the candidates that it was fitted to; a contribution is relative to it.
  double bias = 0.0;

  [[nodiscard]] double log_odds(const Features& features) const;
  [[nodiscard]] double probability(const Features& features) const;
  /// What each feature adds to the log odds.
  [[nodiscard]] Features contributions(const Features& features) const;

  bool operator==(const EvidenceTable&) const = default;
};

/// Fitted to the sources in docs/provenance.md by `ellipse-evaluate --fit-evidence`.
[[nodiscard]] const EvidenceTable& built_in_evidence();

/// Reads lines "FEATURE WEIGHT MEAN" and "bias VALUE"; # begins a comment. Throws
/// std::invalid_argument that names file and line where one is wrong, missing or there twice.
[[nodiscard]] EvidenceTable read_evidence(const std::filesystem::path& file);

/// The same form.
void write_evidence(std::ostream& out, const EvidenceTable& table);

}  // namespace ellipse
