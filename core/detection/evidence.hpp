#pragma once  // SPDX-License-Identifier: MIT

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <span>

namespace ellipse {

/// ln(p / (1 - p)). Clamped, so that 0 and 1 give the finite values -27.6 and 27.6.
[[nodiscard]] inline double log_odds(double probability) {
  const double p = std::clamp(probability, 1e-12, 1.0 - 1e-12);
  return std::log(p / (1.0 - p));
}

/// Inverse of ln(p / (1 - p)).
[[nodiscard]] inline double probability_of(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

/// An ellipse with at least these log odds is certain; one below their negative is ruled out.
inline constexpr double kCertainLogOdds = 3.0;

[[nodiscard]] inline bool is_certain(double probability) {
  return log_odds(probability) >= kCertainLogOdds;
}

/// Measurements along a candidate's outline: the inputs of the logistic regression.
enum class Feature : std::size_t {
  kTurnSupport,     ///< Share of the outline's turn inside the picture matched by edges, 0 to 1.
  kDirectionError,  ///< ln of the median angle between the gradient and the normal [rad].
  /// ln of turn support x the lesser of 1 - longest gap between edges, as a share of the outline,
  /// and the share of its turn inside the picture.
  kCoverage,
  kLength,     ///< ln(1 + length of the outline inside the picture) [px].
  kDeviation,  ///< ln of the RMS distance of the edges from the outline [radii].
  kChanges,    ///< Number of changes of polarity around the outline, per edge.
  kContrast,   ///< ln of the mean gradient over GradientMap::texture().
  kCorners,    ///< Share of the outline's turn that is in evenly spaced corners, about 0 to 1.
};
inline constexpr std::size_t kFeatures = 8;

using Features = std::array<double, kFeatures>;

/// Texts of a feature for display.
struct FeatureInfo {
  const char* nick;         ///< In kebab-case.
  const char* description;  ///< A noun phrase.
};

/// Static lifetime; thread-safe.
[[nodiscard]] std::span<const FeatureInfo, kFeatures> feature_infos();

/// Logistic regression: the log odds of an ellipse are bias + sum of weight x (feature - mean).
struct EvidenceTable {
  Features weights{};
  Features means{};  ///< Over the training candidates; contributions are relative to them.
  double bias = 0.0;

  [[nodiscard]] double log_odds(const Features& features) const;
  [[nodiscard]] double probability(const Features& features) const;
  /// The term of each feature in the log odds.
  [[nodiscard]] Features contributions(const Features& features) const;

  bool operator==(const EvidenceTable&) const = default;
};

/// Fitted to the sources in docs/provenance.md by `ellipse-evaluate --fit-evidence`.
[[nodiscard]] const EvidenceTable& built_in_evidence();

/// Reads lines "FEATURE WEIGHT MEAN" and "bias VALUE"; # begins a comment. Throws
/// std::invalid_argument that names the file if it cannot be read, or if an entry is wrong, missing
/// or duplicate.
[[nodiscard]] EvidenceTable read_evidence(const std::filesystem::path& file);

/// Writes the format of read_evidence().
void write_evidence(std::ostream& out, const EvidenceTable& table);

}  // namespace ellipse
