#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/ellipse.hpp"
#include "examples/evaluate/bent_frame.hpp"

namespace evaluate {

/// What a frame shows, according to its data set.
struct Truth {
  /// The target's outer edge [px]; in the ideal plane where a lens bends the picture. nullopt where
  /// the frame shows nothing of the target.
  std::optional<ellipse::Ellipse> target;
  /// Share of the perimeter inside the frame, 0 where the target is larger than the frame. nullopt
  /// where the data set does not say.
  std::optional<double> visible_fraction;
  /// False where the target is known to be there, but not where: such a frame is not judged.
  bool is_labelled = true;
};

/// What is varied among frames that are otherwise the same, where the data set says so.
struct Conditions {
  std::optional<double> noise;    ///< Standard deviation [grey levels].
  std::optional<double> crumple;  ///< Departure of the edge from its ellipse, of the radius.
};

struct Frame {
  std::string name;             ///< As "sequence/file", for people and for other programs.
  std::filesystem::path image;  ///< To be read; empty where the frame is rendered.
  std::size_t number = 0;       ///< In its sequence.
  std::int64_t pts_ns = 0;      ///< Its time.
  Truth truth;
  Conditions conditions;
};

/// Where the pictures of a sequence come from.
class PictureSource {
 public:
  virtual ~PictureSource() = default;

  /// 8-bit grey levels. Throws std::runtime_error that names the frame, where there is no picture.
  [[nodiscard]] virtual cv::Mat picture(const Frame& frame) = 0;
};

/// Frames that follow each other in time.
struct Sequence {
  std::string dataset;  ///< Figures are given for each data set.
  std::string name;
  std::vector<Frame> frames;  ///< In the natural order of their file names.
  std::shared_ptr<PictureSource> pictures;
  std::shared_ptr<const BentFrame> bent{};  ///< What a lens makes of the frames; else nullptr.
};

struct Dataset {
  std::vector<Sequence> sequences;
  /// What could not be used, each naming file and line.
  std::vector<std::string> problems;
  /// Rows of the truth that are lost to these problems.
  std::size_t missing_frames = 0;
};

/// Reads a data set from a folder with `gt.csv` (columns image, cx, cy, semi_major, semi_minor,
/// angle_rad and, if there, visible_fraction, pts_ns, noise, crumple, dataset; images named
/// relative to the folder), or with the `ground_truth.txt` of the published AirLab data set, in the
/// folder itself or in folders below.
///
/// Frames without a time are 1/30 s apart. A broken line, a line whose image is not there, and an
/// image without a line are problems; the other frames are there. Throws std::runtime_error that
/// names the file, where there is no table, or none that can be read. gst_init() must have been
/// called.
[[nodiscard]] Dataset read_dataset(const std::filesystem::path& folder);

/// Writes rendered pictures and `gt.csv`, from which read_dataset() gives the same frames.
/// @param advance  Called after each frame; false ends it early.
/// Throws std::runtime_error that names the file, where it cannot be written.
void write_dataset(const std::vector<Sequence>& sequences,
                   const std::filesystem::path& folder,
                   const std::function<bool(const Frame&)>& advance);

}  // namespace evaluate
