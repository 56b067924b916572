#pragma once  // SPDX-License-Identifier: MIT

#include <algorithm>
#include <cmath>
#include <span>

namespace ellipse {

/// Tukey's biweight [BeatonTukey1974]: 1 for no distance, 0 from `reach` on.
[[nodiscard]] inline double tukey_weight(double distance, double reach) {
  const double r = distance / reach;
  return std::abs(r) < 1.0 ? (1.0 - r * r) * (1.0 - r * r) : 0.0;
}

/// The median; of an even number of values, the larger one in the middle. Reorders the values, at
/// least one. O(n).
template <typename Value>
[[nodiscard]] Value median(std::span<Value> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A value and its standard deviation.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;
};

/// A distance from a model, and its weight.
struct WeightedDistance {
  double distance = 0.0;
  double weight = 1.0;
};

/// Standard deviation of normal errors, from the weighted median of their absolute values. Reorders
/// the distances, at least one, finite or infinite. O(n log n).
[[nodiscard]] double robust_sigma(std::span<WeightedDistance> distances);

/// Covariance of a least-squares fit with Tukey's biweight, from its residuals: these need not be
/// normal, and those of neighbours may be correlated, since an edge is not exactly elliptical or
/// one disturbance reaches several samples. Allocates nothing.
class ResidualSums {
 public:
  /// To be called in the order of the samples, also for those beyond the reach.
  /// @param sample     Its index, from 0.
  /// @param precision  Weight of the sample without Tukey's; the unit does not matter.
  void add(int sample, double distance, double reach, double precision);

  /// Effective number of samples within the reach, given their precisions [Kish1965]. 0 if there
  /// are none.
  [[nodiscard]] double samples() const;

  /// Factor from the fit's information, in which each sample has the weight precision x
  /// tukey_weight(), to that with these residuals: [Huber1981], 7.6, for the robust weights, and
  /// [Bartlett1946] for the correlation.
  /// @param parameters  Number of fitted parameters.
  /// @param min_sigma   Min standard deviation of a residual.
  [[nodiscard]] double information_factor(int parameters, double min_sigma) const;

  /// The same for independent samples of precision 1 that outnumber the parameters by far. At most
  /// 1 / min_sigma^2; near 0 if the residuals are spread evenly over the reach.
  [[nodiscard]] double independent_precision(double min_sigma) const;

 private:
  // Number of samples per independent one.
  [[nodiscard]] double samples_per_independent(int parameters) const;
  // Factor of the variance for few samples.
  [[nodiscard]] double small_sample_factor(int parameters, double independent) const;

  double all_precisions_ = 0.0;
  double precisions_ = 0.0;  // of samples within the reach, as all below
  double squared_precisions_ = 0.0;
  double weights_ = 0.0;
  double squared_weights_ = 0.0;  // over the precision
  double squares_ = 0.0;          // of influences, over the precision
  double slopes_ = 0.0;           // of the influence
  double squared_slopes_ = 0.0;
  double squares_of_pairs_ = 0.0;   // mean squares of neighbouring residuals,
  double products_of_pairs_ = 0.0;  // and their products
  double last_ = 0.0;
  int last_sample_ = -2;
  int pairs_ = 0;
};

}  // namespace ellipse
