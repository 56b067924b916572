#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <string>
#include <vector>

namespace evaluate {

/// Which sources are left out together, because they share camera, target or place. From lines
///
///     airlab: airlab-*
///     rendered: twin thin scenes
///
/// a group's name, a colon, and names of sources in which * and ? stand for anything (glob(7)).
/// Empty lines and lines that begin with # do not count.
class SourceGroups {
 public:
  /// The AirLab sources; all rendered ones.
  SourceGroups();

  /// Throws std::runtime_error that names file and line.
  explicit SourceGroups(const std::filesystem::path& file);

  /// The first group that has the source, else the source's own name. What stands before a colon
  /// in a source's name does not count: it tells data sets of the same name apart.
  [[nodiscard]] std::string group_of(const std::string& source) const;

 private:
  struct Group {
    std::string name;
    std::vector<std::string> globs;
  };

  std::vector<Group> groups_;
};

}  // namespace evaluate
