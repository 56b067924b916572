#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <span>

#include "core/detection/detector.hpp"

namespace ellipse {

enum class DetectorKind {
  kContours,  ///< [Keipour2021] Algorithm 1.
  kArcs,      ///< Ellipses fitted to single arcs and pairs of arcs.
};

/// Nicks in the order of DetectorKind. Static lifetime; thread-safe.
[[nodiscard]] std::span<const char* const> detector_nicks();

/// Never null. Allocates. The first kArcs of a process computes a table in about 20 ms.
[[nodiscard]] std::unique_ptr<Detector> make_detector(DetectorKind kind);

}  // namespace ellipse
