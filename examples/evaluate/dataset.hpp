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

/// An ellipse that a frame shows.
struct TrueEllipse {
  ellipse::Ellipse ellipse;  ///< [px]; in the ideal plane where a lens distorts the picture.
  /// Share of the perimeter inside the frame, 0 where the ellipse is larger than the frame. nullopt
  /// where the data set does not say.
  std::optional<double> visible_fraction;
};

/// What a frame shows, according to its data set.
struct Truth {
  /// The target's outer edge, as TrueEllipse::ellipse. nullopt where the frame shows no ellipse.
  std::optional<ellipse::Ellipse> target;
  std::optional<double> visible_fraction;  ///< Of the target, as in TrueEllipse.
  /// False where the frame cannot be judged: the place of its target is unknown, or the data set
  /// says to ignore it. Trackers see it all the same.
  bool is_labelled = true;
  /// Further ellipses in the frame. An answer that matches one of them is as right as one that
  /// matches the target.
  std::vector<TrueEllipse> others{};
};

/// The target and the others; empty where the frame shows no ellipse.
[[nodiscard]] std::vector<TrueEllipse> ellipses_of(const Truth& truth);

/// What is varied among frames that are otherwise the same, where the data set says so.
struct Conditions {
  std::optional<double> noise;    ///< Standard deviation [grey levels].
  std::optional<double> crumple;  ///< Departure of the edge from its ellipse, of the radius.
};

struct Frame {
  std::string name;             ///< As "sequence/file", for people and for other programs.
  std::filesystem::path image;  ///< Its file; empty where it is rendered or from a video.
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
  /// What a lens makes of the frames; else nullptr.
  std::shared_ptr<const DistortedFrame> distortion{};
};

struct Dataset {
  std::vector<Sequence> sequences;
  /// What could not be used, each naming file and line.
  std::vector<std::string> problems;
  /// Rows of the truth that are lost to these problems.
  std::size_t missing_frames = 0;
};

/// Reads a data set from a folder with `gt.csv` (columns image, cx, cy, semi_major, semi_minor,
/// angle_rad and, if there, visible_fraction (or visible), inner_semi_major, pts_ns, noise,
/// crumple, dataset; images named relative to the folder), or with the `ground_truth.txt` of the
/// published AirLab data set, in the folder itself or in folders below.
///
/// `gt.csv` has one row per ellipse; an image without an ellipse has one row with empty fields.
/// With inner_semi_major the row also stands for the inner edge of a ring, concentric and alike.
/// Where the folder has a video `eye.mp4` (any container), `images/eye/frame_0012.png` is its frame
/// 12, counted from 0 in the order of decoding, with the time that the video gives it. Images may
/// differ in size. An optional `ignore.txt` names one image a line that is shown to trackers and
/// not judged.
///
/// Images without a time are 1 / frames_per_second apart. A broken line, a line whose image is not
/// there, and an image without a line are problems; the other frames are there. Throws
/// std::runtime_error that names the file, where there is no table, or none that can be read.
/// gst_init() must have been called.
[[nodiscard]] Dataset read_dataset(const std::filesystem::path& folder,
                                   double frames_per_second = 30.0);

/// The data sets in a folder: itself where it has `gt.csv`; else the folders in it that have one,
/// by name; else itself.
[[nodiscard]] std::vector<std::filesystem::path> dataset_folders(
    const std::filesystem::path& folder);

}  // namespace evaluate
