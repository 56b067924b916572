#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace evaluate {

/// A row that cannot be used, named by file and line. The file may go on.
class RowError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One line of a table with a header, and where it stands.
class Row {
 public:
  /// Borrows file and header. Throws RowError where the number of fields is not the header's.
  Row(const std::filesystem::path& file,
      int line,
      const std::vector<std::string>& header,
      std::vector<std::string> fields);

  /// Throws RowError.
  [[noreturn]] void fail(const std::string& what) const;

  [[nodiscard]] bool has(const std::string& column) const;

  /// Throws std::runtime_error where the table has no such column.
  [[nodiscard]] const std::string& text(const std::string& column) const;

  /// Throws RowError where the field is no finite number.
  [[nodiscard]] double number(const std::string& column) const;

  /// nullopt where there is no such column, or nothing in it.
  [[nodiscard]] std::optional<double> optional_number(const std::string& column) const;

 private:
  [[nodiscard]] std::string place() const;

  const std::filesystem::path& file_;
  int line_;
  const std::vector<std::string>& header_;
  std::vector<std::string> fields_;
};

/// Calls `use` with each row, and `skip` with what is wrong with a row that cannot be used.
/// Throws std::runtime_error that names the file, where it cannot be read or is empty.
void for_each_row(const std::filesystem::path& file,
                  char separator,
                  const std::function<void(const Row&)>& use,
                  const std::function<void(const std::string&)>& skip);

}  // namespace evaluate
