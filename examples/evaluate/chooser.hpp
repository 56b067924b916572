#pragma once  // SPDX-License-Identifier: MIT

#include <functional>
#include <string>
#include <vector>

#include "core/tracking/settings.hpp"
#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/measures.hpp"

namespace evaluate {

/// What was fitted or chosen.
struct Choice {
  std::string name;  ///< For people.
  ellipse::TrackerSettings settings;
};

/// Fits or chooses something on some sources. Whatever has parameters that come from data
/// implements this, so that leave_one_out() can judge it on sources that it has not seen.
class Chooser {
 public:
  virtual ~Chooser() = default;

  /// @param sources  Names of data sets, at least one. No other may influence the choice.
  [[nodiscard]] virtual Choice choose(const std::vector<std::string>& sources) = 0;
};

/// A property and the values that it may have.
struct Property {
  std::string name;
  std::vector<std::string> values;
};

/// From "property=a,b,c", "property=a:b:c" or, as a sweep, "property=from:to:step". Numbers that
/// ascend are values: as a range they would hold one value only.
/// Throws std::invalid_argument that names the text.
[[nodiscard]] Property parse_property(const std::string& text);

/// Chooses the point of a grid of properties with the largest mean grade, each source weighted
/// alike; of equal ones the first.
class GridChooser : public Chooser {
 public:
  /// Runs all points on all sequences.
  /// @param settings  Of the method whose properties are varied.
  /// @param advance   Called after each frame; false ends it early.
  /// Throws std::invalid_argument where a property is unknown or refuses a value.
  GridChooser(const std::vector<Property>& grid,
              const ellipse::TrackerSettings& settings,
              const std::vector<Sequence>& sequences,
              Rule rule,
              const std::function<bool(const Frame&)>& advance);

  [[nodiscard]] Choice choose(const std::vector<std::string>& sources) override;

  /// Each names a frame that was left out, and why.
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }

 private:
  struct Point {
    Choice choice;
    std::vector<double> grades;  // by source
  };

  void add_points(const std::vector<Property>& grid, std::size_t depth, const Choice& choice);

  std::vector<Point> points_;
  std::vector<std::string> sources_;
  std::vector<std::string> problems_;
};

}  // namespace evaluate
