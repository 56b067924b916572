#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <span>
#include <vector>

#include "core/detection/arcs/ellipse_verifier.hpp"
#include "core/detection/verdict.hpp"
#include "core/edges/subpixel.hpp"
#include "core/geometry/ellipse.hpp"

namespace ellipse {

class DetectionTrace;

/// Whether an outline of polarity `a` may have a part of polarity `b`, or the reverse.
[[nodiscard]] bool may_agree(Polarity a, Polarity b);

/// Whether two fits are of one ellipse.
/// @param tolerance_px  Width of a pixel of the coarser of the two pictures.
[[nodiscard]] bool are_one_ellipse(const Ellipse& a, const Ellipse& b, double tolerance_px);

/// An ellipse that a search accepted.
struct FoundEllipse {
  MeasuredEllipse measured;  ///< [px of the picture]
  int scale = 1;             ///< Of the reduced picture in which it was found.
};

/// The ellipses of one picture at all its sizes, without duplicates.
///
/// Allocates only when they outnumber those of every earlier picture. One thread at a time.
class FoundEllipses {
 public:
  /// Begins a picture. `trace` receives the verdicts on ellipses that are dropped; may be nullptr;
  /// borrowed.
  void begin(DetectionTrace* trace);

  /// Keeps the more probable one of two duplicates. Duplicates of two sizes are compared if one is
  /// certain; uncertain ones remain for merge_duplicates().
  void add(const FoundEllipse& found);

  /// Whether a certain ellipse was found here at this scale. Only a certain ellipse excludes a
  /// guess: an uncertain one may be a wrong fit.
  [[nodiscard]] bool has_certain(const Ellipse& guess, Polarity polarity, int scale) const;

  /// Merges duplicates of all sizes. Call it after the finer sizes confirmed the ellipses.
  void merge_duplicates();

  /// Drops each ellipse that `judge` rejects.
  /// @param judge  Verdict(FoundEllipse&); may change the ellipse.
  template <class Judge>
  void drop_rejected(const Judge& judge) {
    std::erase_if(all_, [&](FoundEllipse& found) {
      const Verdict verdict = judge(found);
      if (!verdict.is_accepted()) reject(found, verdict);
      return !verdict.is_accepted();
    });
  }

  [[nodiscard]] std::size_t size() const { return all_.size(); }
  [[nodiscard]] std::span<FoundEllipse> all() { return all_; }
  [[nodiscard]] std::span<const FoundEllipse> all() const { return all_; }

 private:
  void merge(const FoundEllipse& found, FoundEllipse& known);
  void reject(const FoundEllipse& found, const Verdict& verdict);

  std::vector<FoundEllipse> all_;
  DetectionTrace* trace_ = nullptr;
};

}  // namespace ellipse
