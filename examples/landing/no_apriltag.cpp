// SPDX-License-Identifier: MIT
//
// Replaces apriltag_pad.cpp if the library is missing.
#include <stdexcept>

#include "examples/landing/apriltag_pad.hpp"

namespace landing {
namespace {

[[noreturn]] void refuse() {
  throw std::runtime_error(
      "method \"apriltag\": not built in; install libapriltag-dev and rebuild");
}

}  // namespace

bool has_apriltag() {
  return false;
}

ellipse::Sheet tag_sheet(const ellipse::Pad& /*pad*/) {
  refuse();
}

std::unique_ptr<Peer> make_apriltag(const ellipse::Camera& /*camera*/,
                                    const ellipse::Pad& /*pad*/,
                                    double /*radius*/) {
  refuse();
}

}  // namespace landing
