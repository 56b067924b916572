#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <span>

#include "core/detection/detector.hpp"

namespace ellipse {

enum class DetectorKind {
  kContours,  ///< [Keipour2021] Algorithm 1.
  kArcs,      ///< Arcs of edges, fitted together.
};

/// Their nicks, in their order.
[[nodiscard]] std::span<const char* const> detector_nicks();

[[nodiscard]] std::unique_ptr<Detector> make_detector(DetectorKind kind);

}  // namespace ellipse
