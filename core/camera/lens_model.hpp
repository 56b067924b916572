#pragma once  // SPDX-License-Identifier: MIT

#include <array>
#include <cmath>

#include "core/camera/arc_tangent.hpp"
#include "core/image/simd.hpp"

namespace ellipse {

// Lens models at focal length 1: in double precision for one point, in single for many at once.
// Branch-free, so that the compiler vectorizes them.

/// A distorted point and the derivatives of both coordinates.
template <class T>
struct Distorted {
  T x;
  T y;
  T x_by_x;
  T x_by_y;
  T y_by_x;
  T y_by_y;
};

/// A function of one variable and its derivative.
template <class T>
struct Slope {
  T value;
  T derivative;
};

/// (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6) [Brown1971], in the rational
/// form of OpenCV, as a function of r^2.
/// @param d  k1, k2, p1, p2, k3, k4, k5, k6.
template <class T>
ELLIPSE_INLINE Slope<T> rational_factor(const std::array<T, 8>& d, T r2) {
  const T above = 1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  const T below = 1 / (1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])));
  const T above_slope = d[0] + r2 * (2 * d[1] + 3 * r2 * d[4]);
  const T below_slope = d[5] + r2 * (2 * d[6] + 3 * r2 * d[7]);
  const T value = above * below;
  return {value, (above_slope - value * below_slope) * below};
}

/// theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8) [KannalaBrandt2006] (6).
/// @param d  k1, k2, k3, k4.
template <class T>
ELLIPSE_INLINE Slope<T> fisheye_angle(const std::array<T, 8>& d, T theta) {
  const T t2 = theta * theta;
  return {theta * (1 + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3])))),
          1 + t2 * (3 * d[0] + t2 * (5 * d[1] + t2 * (7 * d[2] + t2 * 9 * d[3])))};
}

/// Tangential distortion of a decentred lens, added to the radial part [Brown1971].
template <class T>
ELLIPSE_INLINE Distorted<T> tangential(const std::array<T, 8>& d, T x, T y) {
  const T p1 = d[2];
  const T p2 = d[3];
  const T xx = x * x;
  const T yy = y * y;
  const T crossed = 2 * (p1 * x + p2 * y);
  return {2 * p1 * x * y + p2 * (3 * xx + yy),
          p1 * (xx + 3 * yy) + 2 * p2 * x * y,
          2 * p1 * y + 6 * p2 * x,
          crossed,
          crossed,
          6 * p1 * y + 2 * p2 * x};
}

template <class T>
ELLIPSE_INLINE Distorted<T> brown_conrady(const std::array<T, 8>& d, T x, T y) {
  const Slope<T> factor = rational_factor(d, x * x + y * y);
  const Distorted<T> aside = tangential(d, x, y);
  const T slope = 2 * factor.derivative;
  const T crossed = slope * x * y;
  return {factor.value * x + aside.x,
          factor.value * y + aside.y,
          factor.value + slope * x * x + aside.x_by_x,
          crossed + aside.x_by_y,
          crossed + aside.y_by_x,
          factor.value + slope * y * y + aside.y_by_y};
}

ELLIPSE_INLINE double arc_tangent(double x) {
  return std::atan(x);
}

/// For x >= 0.
ELLIPSE_INLINE float arc_tangent(float x) {
  const float angle = arc_tangent_of_share(x > 1.0F ? 1.0F / x : x);
  return x > 1.0F ? 1.57079637F - angle : angle;
}

template <class T>
ELLIPSE_INLINE Distorted<T> kannala_brandt(const std::array<T, 8>& d, T x, T y) {
  constexpr T kAxis = static_cast<T>(1e-18);  // avoids division by 0 on the axis
  const T r2 = x * x + y * y + kAxis;
  const T inverse = 1 / std::sqrt(r2);
  const Slope<T> angle = fisheye_angle(d, arc_tangent(r2 * inverse));
  const T factor = angle.value * inverse;
  const T slope = (angle.derivative / (1 + r2) - factor) * inverse * inverse;
  const T crossed = slope * x * y;
  return {factor * x, factor * y, factor + slope * x * x, crossed, crossed, factor + slope * y * y};
}

}  // namespace ellipse
