#pragma once  // SPDX-License-Identifier: MIT

#include <optional>
#include <string>

#include "examples/live/http/http_server.hpp"

namespace live {

/// The files of the page: those built into the program, or those of a folder, for whoever works on
/// the page.
class PageFiles {
 public:
  /// @param folder  Empty = the ones built in.
  explicit PageFiles(std::string folder) : folder_(std::move(folder)) {}

  /// @param name  "index.html", "app.js": one part of a path. Nothing else is ever opened.
  [[nodiscard]] Reply get(const std::string& name) const;

 private:
  [[nodiscard]] std::optional<std::string> content(const std::string& name) const;

  std::string folder_;
};

}  // namespace live
