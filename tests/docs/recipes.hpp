#pragma once  // SPDX-License-Identifier: MIT

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

// Reads the command lines of a document.
namespace recipes {

/// One block of command lines.
struct Recipe {
  std::string section;
  std::string text;
  std::string shown;              ///< Output according to the document; empty: none given.
  bool waits_for_ctrl_c = false;  ///< Serves or receives for other recipes with the same port.
  bool is_left_out = false;       ///< Marked as not run in front of the block.
};

struct Document {
  std::vector<Recipe> recipes;
  std::map<std::string, std::string> files;  ///< Programs by the name in the sentence above.
};

/// Reads a Markdown document. The caller checks that it could be opened.
inline Document read(const std::string& path) {
  Document document;
  std::ifstream in(path);
  std::string section;
  std::string before;  // the paragraph above a block
  bool is_below_recipe = false;
  for (std::string line; std::getline(in, line);) {
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent == std::string::npos || !line.substr(indent).starts_with("```")) {
      if (line.starts_with("#")) section = line.substr(line.find(' ') + 1);
      before = line.empty() ? "" : before + line + " ";
      if (!line.empty()) is_below_recipe = false;
      continue;
    }
    const std::string language = line.substr(indent + 3);
    const std::string end = std::string(indent, ' ') + "```";
    std::string text;
    while (std::getline(in, line) && line != end) {
      text += line.substr(std::min(indent, line.size())) + "\n";
    }
    std::smatch name;
    if (language == "sh") {
      const bool waits = text.starts_with("# until Ctrl-C\n");
      const bool is_elsewhere = text.starts_with("./examples/") || text.starts_with("./tests/");
      const bool is_left_out = is_elsewhere || before.ends_with("*Not run by the tests:* ");
      document.recipes.push_back({section, text, "", waits, is_left_out});
    } else if (language.empty() && is_below_recipe) {
      document.recipes.back().shown = text;
    } else if (std::regex_search(before, name, std::regex("`(\\w+\\.(c|py))`"))) {
      document.files[name[1]] = text;
    }
    is_below_recipe = language == "sh";
    before.clear();
  }
  return document;
}

/// The first group of each match of a pattern in a text.
inline std::vector<std::string> all_of(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), regex);
       it != std::sregex_iterator();
       ++it) {
    found.push_back((*it)[1]);
  }
  return found;
}

/// The ports that occur in a recipe or in the programs that it starts.
inline std::vector<std::string> ports_of(const Recipe& recipe, const Document& document) {
  std::string text = recipe.text;
  for (const auto& [name, program] : document.files) {
    if (recipe.text.find(name) != std::string::npos) text += program;
  }
  return all_of(text, "\\b(1883|5000|5005|8554)\\b");
}

inline bool share_a_port(const Recipe& a, const Recipe& b, const Document& document) {
  const std::vector<std::string> ports = ports_of(a, document);
  const std::vector<std::string> others = ports_of(b, document);
  return std::find_first_of(ports.begin(), ports.end(), others.begin(), others.end()) !=
         ports.end();
}

}  // namespace recipes
