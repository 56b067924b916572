#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <string>
#include <vector>

namespace evaluate {

/// Groups of sources that are left out together because they share camera, target or location. File
/// format:
///
///     airlab: airlab-*
///     rendered: twin thin scenes
///
/// Each line has a group's name, a colon, and names of sources with the wildcards * and ?
/// (glob(7)). Empty lines and lines that begin with # are ignored.
class SourceGroups {
 public:
  /// Default groups: the AirLab sources, and all rendered ones.
  SourceGroups();

  /// Throws std::runtime_error with file and line.
  explicit SourceGroups(const std::filesystem::path& file);

  /// The first group that contains the source, otherwise the source's own name. A prefix up to a
  /// colon in a source's name is ignored; it distinguishes data sets of the same name.
  [[nodiscard]] std::string group_of(const std::string& source) const;

 private:
  struct Group {
    std::string name;
    std::vector<std::string> globs;
  };

  std::vector<Group> groups_;
};

}  // namespace evaluate
