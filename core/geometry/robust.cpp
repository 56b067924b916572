// SPDX-License-Identifier: MIT
#include "core/geometry/robust.hpp"

namespace ellipse {
namespace {

constexpr double kSigmaOfMedian = 1.4826;  // over the median of absolute normal errors

}  // namespace

double robust_sigma(std::span<WeightedDistance> distances) {
  double weights = 0.0;
  for (WeightedDistance& one : distances) {
    one.distance = std::abs(one.distance);
    weights += one.weight;
  }
  std::sort(
      distances.begin(), distances.end(), [](const WeightedDistance& a, const WeightedDistance& b) {
        return a.distance < b.distance;
      });
  std::size_t i = 0;
  for (double below = distances[0].weight; below <= 0.5 * weights && i + 1 < distances.size();) {
    below += distances[++i].weight;
  }
  return kSigmaOfMedian * distances[i].distance;
}

// The influence of a sample is its weight x distance.
void ResidualSums::add(int sample, double distance, double reach, double precision) {
  const double weight = tukey_weight(distance, reach);
  all_precisions_ += precision;
  if (!(weight > 0.0)) return;
  const double share = distance / reach;
  const double slope = (1.0 - share * share) * (1.0 - 5.0 * share * share);
  precisions_ += precision;
  squared_precisions_ += precision * precision;
  weights_ += precision * weight;
  squared_weights_ += precision * weight * weight;
  squares_ += precision * weight * weight * distance * distance;
  slopes_ += precision * slope;
  squared_slopes_ += precision * slope * slope;
  const double residual = std::sqrt(precision * weight) * distance;
  if (sample == last_sample_ + 1) {
    products_of_pairs_ += last_ * residual;
    squares_of_pairs_ += 0.5 * (last_ * last_ + residual * residual);
    ++pairs_;
  }
  last_ = residual;
  last_sample_ = sample;
}

double ResidualSums::samples() const {
  return precisions_ > 0.0 ? precisions_ * precisions_ / squared_precisions_ : 0.0;
}

// The variance of a mean of correlated samples is (1 + rho) / (1 - rho) times that of independent
// ones, with rho between neighbours [Bartlett1946]. A fit of p parameters reduces rho by about p /
// n, as that of a mean does by 1 / n [MarriottPope1954].
double ResidualSums::samples_per_independent(int parameters) const {
  if (!(squares_of_pairs_ > 0.0)) return 1.0;
  const double max_rho = (samples() - 1.0) / (samples() + 1.0);  // all samples are one
  const double rho =
      products_of_pairs_ / squares_of_pairs_ + static_cast<double>(parameters) / pairs_;
  const double bounded = std::clamp(rho, 0.0, max_rho);
  return (1.0 + bounded) / (1.0 - bounded);
}

// K^2 of [Huber1981], 7.6: the influences have different slopes.
double ResidualSums::small_sample_factor(int parameters, double independent) const {
  const double mean = slopes_ / all_precisions_;
  const double variance = squared_slopes_ / all_precisions_ - mean * mean;
  const double k = 1.0 + parameters / independent * variance / (mean * mean);
  return k * k;
}

double ResidualSums::independent_precision(double min_sigma) const {
  if (!(slopes_ > 0.0)) return 0.0;
  const double squares = std::max(squares_, squared_weights_ * min_sigma * min_sigma);
  return slopes_ * slopes_ / (weights_ * squares);
}

double ResidualSums::information_factor(int parameters, double min_sigma) const {
  if (!(slopes_ > 0.0)) return 0.0;
  const double independent = samples() / samples_per_independent(parameters);
  // The errors of p parameters follow Student's t with n - p degrees of freedom if the variance is
  // estimated from n residuals; its covariance is the sum of their squares over n - p - 2.
  const double free = std::max(1.0, independent - parameters - 2.0);
  const double squares = std::max(squares_, squared_weights_ * min_sigma * min_sigma) *
                         small_sample_factor(parameters, independent);
  return slopes_ * slopes_ / (weights_ * squares) * free / precisions_;
}

}  // namespace ellipse
