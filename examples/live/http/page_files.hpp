#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <string>

#include "examples/live/http/http_server.hpp"

namespace live {

/// The files of the page, either compiled into the program or, for development, in a folder.
class PageFiles {
 public:
  /// @param folder  Empty = compiled files.
  explicit PageFiles(std::string folder) : folder_(std::move(folder)) {}

  /// @param name  A plain file name such as "app.js". Anything else gets 404 and opens no file.
  [[nodiscard]] Reply get(const std::string& name) const;

 private:
  [[nodiscard]] std::optional<std::string> content(const std::string& name) const;

  std::string folder_;
};

}  // namespace live
