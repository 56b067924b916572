#pragma once  // SPDX-License-Identifier: MIT

#include <string>

#include "examples/landing/landing.hpp"

namespace landing {

/// Flies a landing once more, and writes it as a Matroska file: what the camera sees with what was
/// found in it, and a map beside it.
/// Throws std::runtime_error where the file cannot be written.
void film(const Flight& flight, const std::string& file);

}  // namespace landing
