#pragma once  // SPDX-License-Identifier: MIT

#include <cstdint>

#include "core/geometry/ellipse.hpp"
#include "core/tracking/frame_clock.hpp"
#include "core/tracking/target.hpp"

namespace ellipse {

/// The last reported target, and how long ago it was reported. Judges whether an ellipse may be
/// this target again.
///
/// Deterministic; allocates nothing; one thread at a time.
class TargetMemory {
 public:
  /// Prior log odds of an ellipse like a target that was certain within the last kMemory_s; the
  /// largest prior. See docs/provenance.md, "Evidence over time".
  static constexpr double kLostPrior = 2.0;

  /// Call once per frame.
  void advance(double elapsed_s);
  void remember(const Target& target);
  /// Forgets when a target was reported; id() and ellipse() stay.
  void forget() { absence_s_ = since_certain_s_ = kMemory_s; }

  [[nodiscard]] const Ellipse& ellipse() const { return ellipse_; }
  /// 0 before the first target.
  [[nodiscard]] std::uint64_t id() const { return id_; }
  /// Time since a target was reported [s]; at least kMemory_s if none was.
  [[nodiscard]] double absence_s() const { return absence_s_; }
  /// Whether a target was certain shortly before.
  [[nodiscard]] bool was_certain() const { return since_certain_s_ < kMemory_s; }

  /// Whether a target was reported shortly before, within the semi-major axis of this ellipse.
  [[nodiscard]] bool was_near(const Ellipse& e) const;
  /// Whether a target was certain shortly before and had nearly this ellipse.
  [[nodiscard]] bool was_certain_as(const Ellipse& e) const;
  /// Log odds that an ellipse is a target, before it is found.
  [[nodiscard]] double prior_of(const Ellipse& e) const;

 private:
  Ellipse ellipse_;
  std::uint64_t id_ = 0;
  double absence_s_ = kMemory_s;
  double since_certain_s_ = kMemory_s;  // since its odds were certain
};

/// Whether the centre of an ellipse is within the semi-major axis of another one.
[[nodiscard]] bool is_near(const Ellipse& e, const Ellipse& other);

}  // namespace ellipse
