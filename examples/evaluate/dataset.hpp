#pragma once  // SPDX-License-Identifier: MIT

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/ellipse.hpp"
#include "examples/evaluate/distorted_frame.hpp"

namespace evaluate {

/// An ellipse visible in a frame.
struct TrueEllipse {
  ellipse::Ellipse ellipse;  ///< [px]; in the ideal plane if a lens distorts the frame.
  /// Fraction of the perimeter inside the frame; 0 if the ellipse encloses the frame. nullopt if
  /// the data set does not specify it.
  std::optional<double> visible_fraction;
};

/// Ground truth of a frame.
struct Truth {
  /// The target's outer edge, see TrueEllipse::ellipse. nullopt if the frame shows no ellipse.
  std::optional<ellipse::Ellipse> target;
  std::optional<double> visible_fraction;  ///< Of the target, see TrueEllipse.
  /// False if the frame is not judged: the target's position is unknown, or the data set ignores
  /// the frame. Trackers still process it.
  bool is_labelled = true;
  /// False if the frame shows more ellipses than it lists: a candidate that is not listed is then
  /// not known to be wrong.
  bool is_complete = true;
  /// Further ellipses in the frame. An answer that matches one of them is also right.
  std::vector<TrueEllipse> others{};
};

/// The target and the others; empty if the frame shows no ellipse.
[[nodiscard]] std::vector<TrueEllipse> ellipses_of(const Truth& truth);

/// Parameters that a data set varies between otherwise identical frames.
struct Conditions {
  std::optional<double> noise;    ///< Standard deviation [grey levels].
  std::optional<double> crumple;  ///< Edge deviation from the ellipse, relative to its radius.
};

struct Frame {
  std::string name;             ///< "sequence/file", for messages and other programs.
  std::filesystem::path image;  ///< Image file; empty for rendered and video frames.
  std::size_t number = 0;       ///< Index in the sequence.
  std::int64_t pts_ns = 0;      ///< Timestamp.
  Truth truth;
  Conditions conditions;
};

/// Provides the pictures of a sequence.
class PictureSource {
 public:
  virtual ~PictureSource() = default;

  /// The 8-bit grey picture of a frame. Throws std::runtime_error that names the frame if it cannot
  /// be read.
  [[nodiscard]] virtual cv::Mat picture(const Frame& frame) = 0;
};

/// Consecutive frames.
struct Sequence {
  std::string dataset;  ///< Results are reported per data set.
  std::string name;
  std::vector<Frame> frames;  ///< In natural order of file names.
  std::shared_ptr<PictureSource> pictures;
  /// The frames' lens distortion; nullptr for a pinhole camera.
  std::shared_ptr<const DistortedFrame> distortion{};
};

struct Dataset {
  std::vector<Sequence> sequences;
  /// Errors in the data set, with file and line.
  std::vector<std::string> problems;
  /// Number of rows skipped because of such errors.
  std::size_t missing_frames = 0;
};

/// Reads a data set from a folder with `gt.csv`, or from a folder tree with the `ground_truth.txt`
/// of the published AirLab data set. Columns of `gt.csv`: image, cx, cy, semi_major, semi_minor,
/// angle_rad; optional: visible_fraction (or visible), inner_semi_major, pts_ns, noise, crumple,
/// dataset. Image names are relative to the folder.
///
/// `gt.csv` has one row per ellipse; an image without an ellipse has one row with empty fields.
/// inner_semi_major adds the inner edge of a ring, concentric and of the same shape. If the folder
/// has a video `eye.mp4` (any container), `images/eye/frame_0012.png` denotes its frame 12, counted
/// from 0 in decoding order, with the video's timestamp. Images may differ in size. An optional
/// `ignore.txt` lists images, one per line, that trackers process but that are not judged.
///
/// Images without a timestamp are 1 / frames_per_second apart. An invalid row, a row without its
/// image, and an image without a row are reported as problems; the other frames are read. Throws
/// std::runtime_error that names the file if there is no readable table. Requires gst_init().
[[nodiscard]] Dataset read_dataset(const std::filesystem::path& folder,
                                   double frames_per_second = 30.0);

/// The data sets in a folder: the folder itself if it has `gt.csv`; otherwise its subfolders that
/// have one, by name; if there are none, the folder itself.
[[nodiscard]] std::vector<std::filesystem::path> dataset_folders(
    const std::filesystem::path& folder);

}  // namespace evaluate
