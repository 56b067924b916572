#pragma once  // SPDX-License-Identifier: MIT

#include <functional>
#include <string>
#include <vector>

#include "core/tracking/settings.hpp"
#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/measures.hpp"

namespace evaluate {

/// Settings that were fitted or chosen.
struct Choice {
  std::string name;  ///< Description for output.
  ellipse::TrackerSettings settings;
};

/// Fits or chooses settings on some sources. Implemented by everything with parameters derived from
/// data, so that leave_one_out() can evaluate it on unseen sources.
class Chooser {
 public:
  virtual ~Chooser() = default;

  /// @param sources  Names of data sets, at least one. The choice depends on these only.
  [[nodiscard]] virtual Choice choose(const std::vector<std::string>& sources) = 0;
};

/// A property and its candidate values.
struct Property {
  std::string name;
  std::vector<std::string> values;
};

/// Parses "property=a,b,c", "property=a:b:c" or the range "property=from:to:step". Three numbers
/// are a range only if at least one step fits.
/// Throws std::invalid_argument that quotes the text.
[[nodiscard]] Property parse_property(const std::string& text);

/// Chooses the point of a property grid with the largest mean grade, with equal weights for all
/// sources. On a tie, the first point wins.
class GridChooser : public Chooser {
 public:
  /// Evaluates all points on all sequences.
  /// @param settings  Base settings of the method.
  /// @param advance   Called after each frame; returning false stops early.
  /// Throws std::invalid_argument if a property is unknown or rejects a value.
  GridChooser(const std::vector<Property>& grid,
              const ellipse::TrackerSettings& settings,
              const std::vector<Sequence>& sequences,
              Rule rule,
              const std::function<bool(const Frame&)>& advance);

  [[nodiscard]] Choice choose(const std::vector<std::string>& sources) override;

  /// One message per skipped frame, with the reason.
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }

 private:
  struct Point {
    Choice choice;
    std::vector<double> grades;  // one per source
  };

  void add_points(const std::vector<Property>& grid, std::size_t depth, const Choice& choice);

  std::vector<Point> points_;
  std::vector<std::string> sources_;
  std::vector<std::string> problems_;
};

}  // namespace evaluate
