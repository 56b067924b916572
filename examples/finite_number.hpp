#pragma once  // SPDX-License-Identifier: MIT

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

/// A check of an option that takes a number: CLI::Range and CLI::PositiveNumber let "nan" pass,
/// which is not below any limit, and the latter "inf".
inline CLI::Validator finite_number() {
  return CLI::Validator(
      [](const std::string& text) {
        double number = 0.0;
        const bool is_finite = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
        return is_finite ? std::string() : "\"" + text + "\" is not a finite number";
      },
      "");
}
