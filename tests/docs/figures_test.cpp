// SPDX-License-Identifier: MIT
//
// Checks the command lines of the documents that lead from a case or a symptom to a setting. A
// comment beside each says how many of its frames have a target.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "tests/docs/json_lines.hpp"
#include "tests/docs/recipes.hpp"
#include "tests/gst/loopback.hpp"
#include "tests/support/shell_job.hpp"

namespace {

using recipes::Recipe;

struct Command {
  std::string document;
  Recipe recipe;
};

// Commands on rendered scenes; others need the reader's files.
std::vector<Command> commands() {
  std::vector<Command> all;
  for (const char* name : {"troubleshooting", "settings-by-case"}) {
    for (const Recipe& recipe :
         recipes::read(std::string(ELLIPSE_ROOT "/docs/") + name + ".md").recipes) {
      if (recipe.text.find("ellipsetestsrc") != std::string::npos) all.push_back({name, recipe});
    }
  }
  return all;
}

class Figures : public testing::TestWithParam<Command> {};

// Compilers differ in the last bits, which decide about a target near a limit.
TEST_P(Figures, MatchTheDocument) {
  const std::string& text = GetParam().recipe.text;
  const support::TemporaryFolder folder;
  support::ShellJob job(text, folder.file(""), "job");
  EXPECT_EQ(job.wait_for_end(), 0) << text << job.errors();
  std::smatch counts;
  const std::regex comment("# a target in (\\d+) of (\\d+) frames\n");
  if (!std::regex_search(text, counts, comment)) {
    EXPECT_TRUE(text.starts_with("# ")) << "neither a number of targets nor a reason: " << text;
    EXPECT_NE(job.output(), "") << text;
    return;
  }
  const auto lines = recipes::json_lines_of(job.output());
  EXPECT_EQ(lines.size(), std::stoul(counts[2])) << text;
  const auto found = std::count_if(
      lines.begin(), lines.end(), [](const recipes::JsonLine& line) { return line.has_target; });
  const double expected = std::stod(counts[1]);
  EXPECT_NEAR(static_cast<double>(found), expected, expected == 0.0 ? 0.0 : 2.0) << text;
}

std::string name_of(const testing::TestParamInfo<Command>& info) {
  std::string name;
  for (const char c : info.param.document + " " + info.param.recipe.section) {
    if (std::isalnum(c) != 0) name += c;
  }
  return name + std::to_string(info.index);
}

INSTANTIATE_TEST_SUITE_P(Documents, Figures, testing::ValuesIn(commands()), name_of);

}  // namespace
