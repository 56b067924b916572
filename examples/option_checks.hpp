#pragma once  // SPDX-License-Identifier: MIT

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

// CLI::Range, CLI::PositiveNumber and CLI::NonNegativeNumber accept "nan", because it is not below
// any limit. The latter two print their largest value with 300 digits.

/// Rejects options that are not finite numbers.
inline CLI::Validator finite_number() {
  return CLI::Validator(
      [](const std::string& text) {
        double number = 0.0;
        const bool is_finite = CLI::detail::lexical_cast(text, number) && std::isfinite(number);
        return is_finite ? std::string() : "\"" + text + "\" is not a finite number";
      },
      "");
}

/// Rejects options that are not finite numbers above 0.
inline CLI::Validator positive_number() {
  const CLI::Validator is_positive(
      [](const std::string& text) {
        double number = 0.0;
        const bool is_above = CLI::detail::lexical_cast(text, number) && number > 0.0;
        return is_above ? std::string() : "\"" + text + "\" is not above 0";
      },
      "");
  return (finite_number() & is_positive).description("POSITIVE");
}

/// Rejects options that are not integers from 0 on.
inline CLI::Validator non_negative_integer() {
  return CLI::Validator(
      [](const std::string& text) {
        const bool is_integer =
            !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
        return is_integer ? std::string() : "\"" + text + "\" is not an integer from 0 on";
      },
      "NONNEGATIVE");
}
