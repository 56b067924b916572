// SPDX-License-Identifier: MIT
//
// The tables over all sources.
#include "examples/evaluate/source_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace evaluate {
namespace {

constexpr auto kHit = Outcome::kTruePositive;
constexpr auto kMiss = Outcome::kFalseNegative;
constexpr auto kGhost = Outcome::kFalsePositive;
constexpr auto kNone = Outcome::kTrueNegative;

Result result_of(Outcome outcome) {
  Result result;
  result.outcome = outcome;
  return result;
}

Sequence sequence_of(const std::string& dataset, std::size_t frames) {
  Sequence sequence{dataset, "made", {}, nullptr};
  for (std::size_t i = 0; i < frames; ++i) {
    sequence.frames.push_back(
        {std::to_string(i), {}, i, static_cast<std::int64_t>(i) * 40'000'000, {}, {}});
  }
  return sequence;
}

// Two sources, "eye" with a target and "road" without; one of our methods and two peers.
class SourceTables : public testing::Test {
 protected:
  SourceTables() {
    for (const Sequence& sequence : sequences_) {
      for (const Frame& frame : sequence.frames) {
        evaluation_.frames.push_back({&sequence, &frame, {64, 48}});
      }
    }
    add("arcs+edges", 40, kNone, 1);
    add("canny-fit", 2, kGhost, 2);
    add("contours+none", 39, kGhost, 50);
  }

  // Misses every n-th frame of "eye"; every n-th frame of "road" has the given outcome.
  void add(const std::string& name, std::size_t missed, Outcome outcome, std::size_t each) {
    MethodResults method{name, {}, {}};
    for (std::size_t i = 0; i < kFrames; ++i) {
      method.results.push_back(result_of(i % missed == 0 ? kMiss : kHit));
    }
    for (std::size_t i = 0; i < kFrames; ++i) {
      method.results.push_back(result_of(i % each == 0 ? outcome : kNone));
    }
    evaluation_.methods.push_back(std::move(method));
  }

  static constexpr std::size_t kFrames = 400;
  const std::vector<Sequence> sequences_ = {sequence_of("eye", kFrames),
                                            sequence_of("road", kFrames)};
  Evaluation evaluation_;
};

TEST_F(SourceTables, ListEachSourceWithItsBestPeer) {
  const auto results = source_results(evaluation_);
  const Table table = source_table(evaluation_, results);
  ASSERT_EQ(table.rows.size(), 3U);  // and the mean
  EXPECT_EQ(table.rows[0],
            (std::vector<std::string>{
                "eye", "400", "0.987 ", "0.667 ", "0.986=", "contours+none", "0.986", "+0.001="}));
  // Without targets: the share of frames without a false target.
  EXPECT_EQ(table.rows[1],
            (std::vector<std::string>{
                "road", "400", "1.000 ", "0.500 ", "0.980 ", "contours+none", "0.980", "+0.020 "}));
  EXPECT_EQ(table.rows[2][0], "mean of 1 with ellipses");
  EXPECT_EQ(table.rows[2][2], "0.987 ");
}

TEST_F(SourceTables, ListAnIntervalForEachGrade) {
  const auto results = source_results(evaluation_);
  const Interval interval = results[0].methods[1].interval;
  EXPECT_LT(interval.low, results[0].methods[1].grade);
  EXPECT_GT(interval.high, results[0].methods[1].grade);
  const Table table = interval_table(evaluation_, results);
  EXPECT_EQ(table.rows[1][1], "-");  // no errors
  EXPECT_NE(table.note.find("sequences: eye, road"), std::string::npos) << table.note;
}

TEST_F(SourceTables, WrongTargetsCountAsMistakenAndMissed) {
  EXPECT_EQ(counts_of(Outcome::kWrong).mistaken, 1);
  EXPECT_EQ(counts_of(Outcome::kWrong).missed, 1);
  EXPECT_EQ(counts_of(Outcome::kNotJudged).judged, 0);
}

TEST_F(SourceTables, IncludeAllEllipsesOnRequest) {
  EXPECT_EQ(source_tables(evaluation_).size(), 2U);
  for (std::size_t i = 0; i < 2 * kFrames; ++i) {
    AllResult one;
    if (i < kFrames) one = {{1, 2, 1, 0}, {0.5, 1.5}, {0.25, 0.25}};
    evaluation_.methods[2].all.push_back(one);
  }
  const Table table = source_tables(evaluation_).at(2);
  ASSERT_EQ(table.rows.size(), 2U);  // one method, two sources
  EXPECT_EQ(table.rows[0][0], "eye");
  EXPECT_EQ(table.rows[0][2], "800");     // true
  EXPECT_EQ(table.rows[0][3], "1200");    // found
  EXPECT_EQ(table.rows[0][7], "0.8000");  // F1
  EXPECT_EQ(table.rows[1][7], "-");
}

TEST_F(SourceTables, AreAlsoWrittenAsJson) {
  std::ostringstream out;
  write_json_sources(out, evaluation_);
  EXPECT_NE(out.str().find("{\"method\":\"arcs+edges\",\"dataset\":\"road\",\"grade\":1,"
                           "\"interval\":[null,null],\"difference_from_first\":null,"
                           "\"is_best_peer\":false}"),
            std::string::npos)
      << out.str();
}

TEST(Methods, OursAreThoseWithOurDetectorOrOurTracker) {
  for (const char* ours : {"arcs+edges", "arcs+none", "arcs+redetect", "contours+edges"}) {
    EXPECT_TRUE(is_ours(ours)) << ours;
  }
  for (const char* peer : {"contours+none", "contours+redetect", "edge-drawing", "another"}) {
    EXPECT_FALSE(is_ours(peer)) << peer;
  }
}

}  // namespace
}  // namespace evaluate
