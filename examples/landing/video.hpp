#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "examples/landing/landing.hpp"

namespace landing {

/// Simulates a flight again and writes a Matroska video: the camera's picture with the detected
/// target, and a map next to it.
/// Throws std::runtime_error if the file cannot be written.
void film(const Flight& flight, const std::string& file);

}  // namespace landing
