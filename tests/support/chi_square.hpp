#pragma once  // SPDX-License-Identifier: MIT

namespace support {

// 95 % quantiles of a chi-square distribution, by degrees of freedom.
inline constexpr double kChiSquare3 = 7.8147;
inline constexpr double kChiSquare5 = 11.0705;

}  // namespace support
