#pragma once  // SPDX-License-Identifier: MIT

#include <glib.h>

namespace live {

/// Interval of periodic checks [ms].
inline constexpr guint kTickMs = 1000;
/// A connection without a TCP acknowledgement for this time [ms] ends.
inline constexpr gint kAckTimeoutMs = 30'000;
/// A listener that accepts no data for this time [us] is dropped.
inline constexpr gint64 kStallTimeoutUs = 30 * G_USEC_PER_SEC;
/// A quiet stream carries a sign of life after this time [us].
inline constexpr gint64 kKeepaliveUs = 5 * G_USEC_PER_SEC;

}  // namespace live
