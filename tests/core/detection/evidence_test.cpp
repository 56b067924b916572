// SPDX-License-Identifier: MIT
#include "core/detection/evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

namespace ellipse {
namespace {

class EvidenceFile : public testing::Test {
 protected:
  ~EvidenceFile() override { std::filesystem::remove(file_); }

  EvidenceTable read(const std::string& text) {
    std::ofstream(file_) << text;
    return read_evidence(file_);
  }

  std::string message_of(const std::string& text) {
    try {
      (void)read(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path file_ = testing::TempDir() + "evidence_test.txt";
};

std::string text_of(const EvidenceTable& table) {
  std::ostringstream out;
  write_evidence(out, table);
  return out.str();
}

TEST(Evidence, IsTheLogisticFunctionOfTheContributions) {
  const EvidenceTable& table = built_in_evidence();
  Features features = table.means;
  features[0] += 0.1;
  features[3] -= 0.2;
  const Features parts = table.contributions(features);
  const double sum = std::accumulate(parts.begin(), parts.end(), table.bias);
  EXPECT_NEAR(table.log_odds(features), sum, 1e-12);
  EXPECT_NEAR(parts[0], 0.1 * table.weights[0], 1e-12);
  EXPECT_NEAR(table.probability(features), 1.0 / (1.0 + std::exp(-sum)), 1e-12);
  EXPECT_EQ(table.contributions(table.means), Features{});
}

TEST_F(EvidenceFile, ReadInvertsWrite) {
  const EvidenceTable& table = built_in_evidence();
  const EvidenceTable again = read("# comment\n\n" + text_of(table));
  for (std::size_t i = 0; i < kFeatures; ++i) {
    EXPECT_NEAR(again.weights[i], table.weights[i], 1e-5 * std::abs(table.weights[i]));
    EXPECT_NEAR(again.means[i], table.means[i], 1e-5 * std::abs(table.means[i]));
  }
  EXPECT_NEAR(again.bias, table.bias, 1e-5);
}

TEST_F(EvidenceFile, ErrorNamesTheLine) {
  const std::string good = text_of(built_in_evidence());
  const std::string path = file_.string();
  EXPECT_EQ(message_of("size 1 2\n"),
            path + ":1: is not an evidence table: unknown feature \"size\"");
  EXPECT_EQ(message_of("\nlength nan 1\n"), path + ":2: expected a number, not nan");
  EXPECT_EQ(message_of("length 1\n"), path + ":1: expected a number, not the end of the line");
  EXPECT_EQ(message_of("length 1 2x\n"), path + ":1: expected a number, not 2x");
  EXPECT_EQ(message_of("bias 1 2\n"), path + ":1: unexpected 2");
  EXPECT_EQ(message_of(good + "bias 1\n"),
            path + ":" + std::to_string(kFeatures + 2) + ": duplicate entry bias");
  EXPECT_EQ(message_of(good.substr(0, good.find("bias"))), path + ": bias is missing");
  std::filesystem::remove(file_);
  EXPECT_THROW((void)read_evidence(file_), std::invalid_argument);
}

}  // namespace
}  // namespace ellipse
