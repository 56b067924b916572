#pragma once  // SPDX-License-Identifier: MIT

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

/// Rejects options that are not finite numbers. CLI::Range and CLI::PositiveNumber accept "nan",
/// because it is not below any limit; the latter also accepts "inf".
inline CLI::Validator finite_number() {
  return CLI::Validator(
      [](const std::string& text) {
        double number = 0.0;
        const bool is_finite = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
        return is_finite ? std::string() : "\"" + text + "\" is not a finite number";
      },
      "");
}
