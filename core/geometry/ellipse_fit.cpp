// SPDX-License-Identifier: MIT
#include "core/geometry/ellipse_fit.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace ellipse {
namespace {

// Min product of the principal variances of standardized points, which sum to 1: below it the
// points are collinear.
constexpr double kMinVariance = 1e-6;

// Keeps the reduced scatter invertible when the points lie on the ellipse exactly.
constexpr double kRegularization = 1e-13;

constexpr int kBinomial[5][5] = {
    {1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}};

// [HalirFlusser1998] (19)-(21): the scatter S1 of the quadratic monomials (x^2, xy, y^2) minus the
// part explained by the linear ones (x, y, 1): S1 + S2 T with T = -S3^-1 S2^T.
struct ReducedScatter {
  Eigen::Matrix3d quadratic;  // M = S1 + S2 T
  Eigen::Matrix3d linear;     // T
};

ReducedScatter reduced_scatter(const Moments& m) {
  Eigen::Matrix3d s1;
  Eigen::Matrix3d s2;
  Eigen::Matrix3d s3;
  s1 << m.at(4, 0), m.at(3, 1), m.at(2, 2),  //
      m.at(3, 1), m.at(2, 2), m.at(1, 3),    //
      m.at(2, 2), m.at(1, 3), m.at(0, 4);
  s2 << m.at(3, 0), m.at(2, 1), m.at(2, 0),  //
      m.at(2, 1), m.at(1, 2), m.at(1, 1),    //
      m.at(1, 2), m.at(0, 3), m.at(0, 2);
  s3 << m.at(2, 0), m.at(1, 1), m.at(1, 0),  //
      m.at(1, 1), m.at(0, 2), m.at(0, 1),    //
      m.at(1, 0), m.at(0, 1), m.at(0, 0);
  const Eigen::Matrix3d linear = -s3.inverse() * s2.transpose();
  return {s1 + s2 * linear, linear};
}

// Coefficients of det(M - lambda C), from the highest power down.
using Cubic = std::array<double, 4>;

Cubic characteristic(const Eigen::Matrix3d& m) {
  // M - lambda C = [p q r - 2l; q t + l v; r - 2l v w], M symmetric.
  const double p = m(0, 0), q = m(0, 1), r = m(0, 2), t = m(1, 1), v = m(1, 2), w = m(2, 2);
  return {-4.0, 4.0 * (r - t), p * w - r * r + 4.0 * (r * t - q * v), m.determinant()};
}

// Largest root, by Newton's method from above: beyond the largest of three real roots all
// derivatives of a cubic have one sign, so the steps converge monotonically.
double largest_root(const Cubic& c, double above) {
  const auto step_from = [&c](double x) {
    const double value = ((c[0] * x + c[1]) * x + c[2]) * x + c[3];
    const double slope = (3.0 * c[0] * x + 2.0 * c[1]) * x + c[2];
    return x - value / slope;
  };
  double x = above;
  for (double next = step_from(x); next < x; next = step_from(x)) x = next;
  return x;
}

// Minimizes a^T M a under a^T C a = 1, C = [0 0 2; 0 -1 0; 2 0 0] (4 a c - b^2 = 1): M a = lambda C
// a with the only positive lambda [Fitzgibbon1999] Lemma 1. It is at most the value for a circle,
// a = (1/2, 0, 1/2). The solution is orthogonal to all rows of M - lambda C, whose rank is 2.
Eigen::Vector3d constrained_minimum(const Eigen::Matrix3d& scatter) {
  Eigen::Matrix3d m = 0.5 * (scatter + scatter.transpose());
  m.diagonal().array() += kRegularization * m.trace();
  const double of_circle = 0.25 * (m(0, 0) + 2.0 * m(0, 2) + m(2, 2));
  const double lambda = largest_root(characteristic(m), of_circle);
  m(0, 2) -= 2.0 * lambda;
  m(2, 0) -= 2.0 * lambda;
  m(1, 1) += lambda;
  const std::array<Eigen::Vector3d, 3> candidates = {
      m.col(0).cross(m.col(1)), m.col(0).cross(m.col(2)), m.col(1).cross(m.col(2))};
  return *std::max_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.squaredNorm() < b.squaredNorm();
  });
}

// Largest norm of a Gauss-Newton step, in units of the axes.
constexpr double kMaxStep = 0.3;

bool is_collinear(const Moments& standardized) {
  const double n = standardized.total_weight();
  const double xx = standardized.at(2, 0) / n;
  const double xy = standardized.at(1, 1) / n;
  const double yy = standardized.at(0, 2) / n;
  return !(xx * yy - xy * xy > kMinVariance);  // product of the variances; their sum is 1
}

// The sum of F^2 over the sum of |grad F|^2, both over all points [Taubin1991].
double taubin_rms(const Moments& m,
                  const Eigen::Matrix3d& reduced,
                  const Eigen::Vector3d& a,
                  const Eigen::Vector3d& b) {
  const double values = a.dot(reduced * a);
  const double xx = m.at(2, 0);
  const double xy = m.at(1, 1);
  const double yy = m.at(0, 2);
  // (2 a0 x + a1 y + b0)^2 + (a1 x + 2 a2 y + b1)^2; the means of x and y are 0.
  const double slopes = 4.0 * a(0) * a(0) * xx + 4.0 * a(1) * (a(0) + a(2)) * xy +
                        a(1) * a(1) * (xx + yy) + 4.0 * a(2) * a(2) * yy +
                        m.total_weight() * (b(0) * b(0) + b(1) * b(1));
  return std::sqrt(std::max(0.0, values) / slopes);
}

}  // namespace

void Moments::add(const Eigen::Vector2d& point_px, double weight) {
  const double x = point_px.x() - origin_.x();
  const double y = point_px.y() - origin_.y();
  const double xx = x * x;
  const double xy = x * y;
  const double yy = y * y;
  const double terms[15] = {1,
                            x,
                            y,
                            xx,
                            xy,
                            yy,
                            xx * x,
                            xx * y,
                            x * yy,
                            yy * y,
                            xx * xx,
                            xx * xy,
                            xx * yy,
                            xy * yy,
                            yy * yy};
  for (int i = 0; i < 15; ++i) sums_[i] += weight * terms[i];
}

void Moments::add(const Moments& other) {
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
}

Eigen::Vector2d Moments::mean() const {
  return origin_ + Eigen::Vector2d(at(1, 0), at(0, 1)) / total_weight();
}

double Moments::spread_px() const {
  const double n = total_weight();
  const double variance =
      (at(2, 0) + at(0, 2)) / n - Eigen::Vector2d(at(1, 0) / n, at(0, 1) / n).squaredNorm();
  return variance > 0.0 ? std::sqrt(variance) : 0.0;
}

Moments Moments::standardized() const {
  Moments result(Eigen::Vector2d::Zero());
  const double shift_x = -at(1, 0) / total_weight();
  const double shift_y = -at(0, 1) / total_weight();
  const double inverse_scale = 1.0 / spread_px();
  double powers_x[5] = {1};
  double powers_y[5] = {1};
  double scales[5] = {1};
  for (int k = 1; k < 5; ++k) {
    powers_x[k] = powers_x[k - 1] * shift_x;
    powers_y[k] = powers_y[k - 1] * shift_y;
    scales[k] = scales[k - 1] * inverse_scale;
  }
  // (x + s)^i (y + t)^j by the binomial theorem, term by term.
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; i + j < 5; ++j) {
      double sum = 0.0;
      for (int p = 0; p <= i; ++p) {
        for (int q = 0; q <= j; ++q) {
          sum += kBinomial[i][p] * kBinomial[j][q] * powers_x[i - p] * powers_y[j - q] * at(p, q);
        }
      }
      result.sums_[index(i, j)] = sum * scales[i + j];
    }
  }
  return result;
}

std::optional<Ellipse> fit_ellipse(std::span<const Eigen::Vector2d> points_px) {
  if (points_px.empty()) return std::nullopt;
  Moments moments(points_px.front());
  for (const Eigen::Vector2d& point : points_px) moments.add(point);
  return fit_ellipse(moments);
}

std::optional<Ellipse> fit_ellipse(const Moments& moments) {
  const auto fit = fit_with_residual(moments);
  return fit ? std::optional(fit->ellipse) : std::nullopt;
}

std::optional<MomentFit> fit_with_residual(const Moments& moments) {
  if (moments.total_weight() < 5.0) return std::nullopt;  // a conic has five degrees of freedom
  const double spread = moments.spread_px();
  if (!(spread > 0.0) || !std::isfinite(spread)) return std::nullopt;
  const Moments standardized = moments.standardized();
  if (is_collinear(standardized)) return std::nullopt;

  const ReducedScatter scatter = reduced_scatter(standardized);
  const Eigen::Vector3d a = constrained_minimum(scatter.quadratic);
  const Eigen::Vector3d b = scatter.linear * a;
  Eigen::Matrix3d conic;
  conic << a(0), a(1) / 2, b(0) / 2, a(1) / 2, a(2), b(1) / 2, b(0) / 2, b(1) / 2, b(2);
  const std::optional<Ellipse> fit = from_conic(conic);
  if (!fit) return std::nullopt;
  const Eigen::Vector2d center = moments.mean() + spread * fit->center();
  const double residual = taubin_rms(standardized, scatter.quadratic, a, b);
  return MomentFit{
      {center.x(), center.y(), fit->semi_major * spread, fit->semi_minor * spread, fit->angle_rad},
      spread * residual};
}

GeometricFit::GeometricFit(const Ellipse& start)
    : center_(start.center()),
      rotation_(Eigen::Rotation2Dd(start.angle_rad).toRotationMatrix()),
      axes_(start.semi_major, start.semi_minor),
      inverse_axes_(axes_.cwiseInverse()) {}

PerimeterOffset GeometricFit::offset_of(const Eigen::Vector2d& point_px) const {
  const Eigen::Vector2d whitened =
      (rotation_.transpose() * (point_px - center_)).cwiseProduct(inverse_axes_);
  const double r = whitened.norm();
  const Eigen::Vector2d anomaly = r > 0.0 ? Eigen::Vector2d(whitened / r) : Eigen::Vector2d(1, 0);
  const double px_per_unit = 1.0 / anomaly.cwiseProduct(inverse_axes_).norm();
  return {anomaly, px_per_unit, (r - 1.0) * px_per_unit};
}

// r - 1 = u . t + s + e1 cos 2 phi + e2 sin 2 phi for c + M t and M (I + [s+e1 e2; e2 s-e1]).
void GeometricFit::add(const PerimeterOffset& offset, double weight) {
  const double px = offset.px_per_unit;
  const double x = offset.anomaly.x();
  const double y = offset.anomaly.y();
  const LeastSquares<5>::Vector row{x, y, 1.0, x * x - y * y, 2.0 * x * y};
  equations_.add(px * row, offset.distance_px, weight);
}

std::optional<Ellipse> GeometricFit::solve() const {
  if (equations_.samples() < LeastSquares<5>::Vector::SizeAtCompileTime) return std::nullopt;
  const auto solution = equations_.solve();
  if (!solution) return std::nullopt;
  const LeastSquares<5>::Vector step = std::min(1.0, kMaxStep / solution->norm()) * *solution;
  Eigen::Matrix2d change;
  change << 1.0 + step(2) + step(3), step(4), step(4), 1.0 + step(2) - step(3);
  const Eigen::Matrix2d axes = rotation_ * axes_.asDiagonal();
  const Eigen::Matrix2d stretched = axes * change;
  return from_shape(center_ + axes * step.head<2>(), stretched * stretched.transpose());
}

RingUncertainty expected_uncertainty(const Ellipse& e,
                                     double width,
                                     double height,
                                     double sigma_px) {
  constexpr int kSamples = 48;
  constexpr double kIndependentPx = 8.0;  // distance of edges with independent errors
  const double step = kTwoPi / kSamples;
  GeometricFit fit(e);
  for (int i = 0; i < kSamples; ++i) {
    const double t = step * i;
    const Eigen::Vector2d point = e.point_at(t);
    if (!is_in_picture(point, width, height)) continue;
    const double length = step * std::hypot(e.semi_major * std::sin(t), e.semi_minor * std::cos(t));
    fit.add(point, length / (kIndependentPx * sigma_px * sigma_px));
  }
  // If little of the outline is inside, its points do not determine all parameters. A prior with a
  // standard deviation of one radius does.
  return {image_from_pad(e), fit.information() + RingMatrix::Identity()};
}

}  // namespace ellipse
