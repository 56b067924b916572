#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "examples/evaluate/all_ellipses.hpp"
#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/method.hpp"

namespace evaluate {

/// A frame processed by all methods.
struct SeenFrame {
  const Sequence* sequence = nullptr;
  const Frame* frame = nullptr;
  FrameSize size;
};

/// Results of one method, one per frame in the same order.
struct MethodResults {
  std::string name;
  std::vector<Result> results;
  std::vector<AllResult> all;  ///< If all ellipses are evaluated: results of methods that find all.
};

struct Evaluation {
  std::vector<SeenFrame> frames;
  std::vector<MethodResults> methods;
  std::vector<std::string> problems;  ///< One message per skipped frame, with the reason.
  std::size_t missing_frames = 0;     ///< Number of planned frames that were skipped.
  std::size_t planned_frames = 0;
  bool is_interrupted = false;
};

/// Runs all methods and cv::Canny + cv::findContours on each frame, in random order, so that
/// changes of the machine's speed affect all of them equally.
///
/// @param sequences  Borrowed by the result.
/// @param advance    Called after each frame; returning false stops early.
/// @param wants_all  Also compare all ellipses of a frame.
[[nodiscard]] Evaluation evaluate(const std::vector<Sequence>& sequences,
                                  const std::vector<std::unique_ptr<Method>>& methods,
                                  Rule rule,
                                  const std::function<bool(const Frame&)>& advance,
                                  bool wants_all = false);

/// The measures of one method over the frames that satisfy a predicate.
[[nodiscard]] Measures measures_of(const Evaluation& evaluation,
                                   std::size_t method,
                                   const std::function<bool(const SeenFrame&)>& claim);

/// The names of the data sets, and of a data set's sequences, in order of evaluation.
[[nodiscard]] std::vector<std::string> datasets_of(const Evaluation& evaluation);
[[nodiscard]] std::vector<std::string> sequences_of(const Evaluation& evaluation,
                                                    const std::string& dataset);

/// Writes one JSON line per judged frame for one method:
/// {"dataset":"...","image":"...","pts_ns":0,"size":[w,h],"target":[cx,cy,a,b,angle],"scale":1,
/// "tracker":"following","probability":0.9,"visible":0.8,"ms":[..],"outcome":"TP"}. Peers that are
/// other programs or box trackers have no "tracker" and "probability". `visible` is the fraction of
/// the true perimeter inside the frame. `target` is in the ideal plane if a lens distorts the
/// frame.
void write_frames(std::ostream& out, const Evaluation& evaluation, std::size_t method);

}  // namespace evaluate
