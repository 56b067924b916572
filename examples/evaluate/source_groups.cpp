// SPDX-License-Identifier: MIT
#include "examples/evaluate/source_groups.hpp"

#include <fnmatch.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace evaluate {

SourceGroups::SourceGroups()
    : groups_{
          {"airlab", {"airlab-*"}},
          {"rendered", {"twin", "thin", "scenes", "scenes-*", "distorted", "wild", "clutter"}}} {}

SourceGroups::SourceGroups(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') continue;
    const std::size_t colon = line.find(':');
    Group group{line.substr(0, colon), {}};
    std::istringstream globs(colon == std::string::npos ? "" : line.substr(colon + 1));
    for (std::string glob; globs >> glob;) group.globs.push_back(glob);
    if (group.name.empty() || group.globs.empty()) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": \"" + line +
                               "\": expected GROUP: SOURCE...");
    }
    groups_.push_back(std::move(group));
  }
}

std::string SourceGroups::group_of(const std::string& source) const {
  const std::string name = source.substr(source.rfind(':') + 1);
  for (const Group& group : groups_) {
    for (const std::string& glob : group.globs) {
      if (fnmatch(glob.c_str(), name.c_str(), 0) == 0) return group.name;
    }
  }
  return source;
}

}  // namespace evaluate
