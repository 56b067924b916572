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

/// A frame that all methods have seen.
struct SeenFrame {
  const Sequence* sequence = nullptr;
  const Frame* frame = nullptr;
  FrameSize size;
};

/// What one method made of them, in their order.
struct MethodResults {
  std::string name;
  std::vector<Result> results;
  std::vector<AllResult> all;  ///< Where all ellipses are asked for, of methods that find them.
};

struct Evaluation {
  std::vector<SeenFrame> frames;
  std::vector<MethodResults> methods;
  std::vector<std::string> problems;  ///< Each names a frame that was left out, and why.
  std::size_t missing_frames = 0;     ///< Left out, of the planned ones.
  std::size_t planned_frames = 0;
  bool is_interrupted = false;
};

/// Runs all methods on each frame, in random order, so that all meet the same machine in the same
/// mood, and cv::Canny + cv::findContours among them.
///
/// @param sequences  Borrowed by the result.
/// @param advance    Called after each frame; false ends it early.
/// @param wants_all  Whether all ellipses of a frame are compared, too.
[[nodiscard]] Evaluation evaluate(const std::vector<Sequence>& sequences,
                                  const std::vector<std::unique_ptr<Method>>& methods,
                                  Rule rule,
                                  const std::function<bool(const Frame&)>& advance,
                                  bool wants_all = false);

/// The measures of one method over the frames for which the claim holds.
[[nodiscard]] Measures measures_of(const Evaluation& evaluation,
                                   std::size_t method,
                                   const std::function<bool(const SeenFrame&)>& claim);

/// The names of the data sets, and of one's sequences, in the order in which they were seen.
[[nodiscard]] std::vector<std::string> datasets_of(const Evaluation& evaluation);
[[nodiscard]] std::vector<std::string> sequences_of(const Evaluation& evaluation,
                                                    const std::string& dataset);

/// One JSON line for each frame that can be judged, of one method:
/// {"dataset":"...","image":"...","size":[w,h],"target":[cx,cy,a,b,angle],"scale":1,"visible":0.8,
/// "ms":[..],"outcome":"TP"}, visible being the share of the true perimeter inside the frame,
/// target of the ideal plane where a lens distorts the picture.
void write_frames(std::ostream& out, const Evaluation& evaluation, std::size_t method);

}  // namespace evaluate
