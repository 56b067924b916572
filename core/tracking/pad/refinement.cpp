// SPDX-License-Identifier: MIT
#include "core/tracking/pad/refinement.hpp"

namespace ellipse {
namespace {

constexpr const char* kNicks[] = {"none", "edges", "photometric"};

}  // namespace

std::span<const char* const> refinement_nicks() {
  return kNicks;
}

}  // namespace ellipse
