#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace evaluate {

/// Invalid row, with file and line. The rest of the file may be valid.
class RowError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One row of a table with a header.
class Row {
 public:
  /// Borrows file and header. Throws RowError if the number of fields differs from the header's.
  Row(const std::filesystem::path& file,
      int line,
      const std::vector<std::string>& header,
      std::vector<std::string> fields);

  /// Throws RowError with file and line.
  [[noreturn]] void fail(const std::string& what) const;

  [[nodiscard]] bool has(const std::string& column) const;

  /// Throws std::runtime_error if the table has no such column.
  [[nodiscard]] const std::string& text(const std::string& column) const;

  /// Throws RowError if the field is not a finite number.
  [[nodiscard]] double number(const std::string& column) const;

  /// nullopt if the column is missing or the field is empty.
  [[nodiscard]] std::optional<double> optional_number(const std::string& column) const;

 private:
  [[nodiscard]] std::string location() const;

  const std::filesystem::path& file_;
  int line_;
  const std::vector<std::string>& header_;
  std::vector<std::string> fields_;
};

/// Calls `use` for each row, and `skip` with the error of each invalid row.
/// Throws std::runtime_error that names the file if it cannot be read or is empty.
void for_each_row(const std::filesystem::path& file,
                  char separator,
                  const std::function<void(const Row&)>& use,
                  const std::function<void(const std::string&)>& skip);

}  // namespace evaluate
