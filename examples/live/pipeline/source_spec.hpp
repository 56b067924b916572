#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace live {

enum class SourceKind { kTest, kFile, kDevice, kUri, kFolder, kFragment };

[[nodiscard]] const char* nick_of(SourceKind kind);

/// A video source, as the user named it and as GStreamer pipelines.
struct SourceSpec {
  SourceKind kind = SourceKind::kTest;
  std::string text;              ///< As the user wrote it.
  std::string description = {};  ///< For gst_parse_bin_from_description(); ends in raw video.
  std::string launch = {};       ///< The same for a gst-launch line; empty = `description`.
  std::string preparation = {};  ///< Shell commands that `launch` requires; empty = none.
  bool is_live = false;          ///< Cannot be paused; reconnects when it fails or ends.
  /// Temporary folder of numbered links to the pictures; removed with the last reference.
  std::shared_ptr<const std::filesystem::path> numbered = {};
};

/// Frames per second, as a fraction.
struct FrameRate {
  int n = 30;
  int d = 1;
};

/// Parses `10`, `29.97` or `30000/1001`. Throws std::invalid_argument if the rate is not above 0
/// and at most 1000.
[[nodiscard]] FrameRate parse_rate(const std::string& text);

/// Quotes text as a value in a gst-launch line.
[[nodiscard]] std::string quoted(const std::string& text);

/// Parses `test:SCENE`, a file, `/dev/videoN`, a URI, a folder of pictures, or part of a gst-launch
/// line in brackets: `[v4l2src ! jpegdec]`. Opens no device, file or network connection. The
/// pictures of a folder are linked under numbered names in a temporary folder.
///
/// Throws std::invalid_argument that names the source and the error: unknown scene (with the
/// available ones), missing file, camera or picture, no permission to read, invalid pipeline
/// syntax, a frame rate for anything but a folder.
/// @param rate  For a folder of pictures; default 30.
[[nodiscard]] SourceSpec parse_source(const std::string& text,
                                      std::optional<FrameRate> rate = std::nullopt);

}  // namespace live
