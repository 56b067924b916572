#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>
#include <limits>

namespace ellipse {

/// Time from frame to frame. Depacketizers and decoders leave out a time stamp now and then: a
/// frame without one is taken to come after as long as the frame before it did.
class FrameClock {
 public:
  /// @param pts_ns  Time stamp of a frame; negative where it has none.
  /// @return Time since the frame before [1/30 s]: at most 30; 1 where it is not known, as at the
  ///         first frame, in a stream without time stamps, and where time goes back.
  double advance_to(std::int64_t pts_ns);

 private:
  double now_ns_ = std::numeric_limits<double>::quiet_NaN();
  double interval_ = 1.0;
};

}  // namespace ellipse
