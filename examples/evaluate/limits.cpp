// SPDX-License-Identifier: MIT
#include "examples/evaluate/limits.hpp"

#include <cmath>
#include <cstddef>
#include <sstream>

#include "examples/evaluate/measures.hpp"

namespace evaluate {
namespace {

// Collects the limits that one method violates on one data set.
class Check {
 public:
  Check(std::string context, std::vector<std::string>& violations)
      : context_(std::move(context)), violations_(violations) {}

  void at_least(const char* measure, double value, const std::optional<double>& limit) {
    if (!limit || value >= *limit) return;
    std::ostringstream text;
    text << context_ << ": " << measure << ' ';
    if (std::isnan(value)) {
      text << "is undefined because no frame shows a target; at least " << *limit << " required";
    } else {
      text << value << " is below " << *limit;
    }
    violations_.push_back(text.str());
  }
  void at_most(const char* measure, int value, const std::optional<int>& limit) {
    if (!limit || value <= *limit) return;
    std::ostringstream text;
    text << context_ << ": " << value << ' ' << measure << ", at most " << *limit << " allowed";
    violations_.push_back(text.str());
  }

 private:
  std::string context_;
  std::vector<std::string>& violations_;
};

}  // namespace

std::vector<std::string> violated_limits(const Evaluation& evaluation, const Limits& limits) {
  std::vector<std::string> violations;
  for (std::size_t m = 0; m < evaluation.methods.size(); ++m) {
    for (const std::string& dataset : datasets_of(evaluation)) {
      const Measures measures = measures_of(evaluation, m, [&](const SeenFrame& frame) {
        return frame.sequence->dataset == dataset;
      });
      Check check(evaluation.methods[m].name + " on " + dataset, violations);
      check.at_least("F1", measures.f1(), limits.min_f1);
      check.at_least("recall", measures.recall(), limits.min_recall);
      check.at_most("frames with a false answer",
                    measures.count(Outcome::kFalsePositive) + measures.count(Outcome::kWrong),
                    limits.max_false);
    }
  }
  return violations;
}

}  // namespace evaluate
