#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace live {

enum class SourceKind { kTest, kFile, kDevice, kUri, kFolder, kFragment };

[[nodiscard]] const char* nick_of(SourceKind kind);

/// Where the video comes from, as a person says it and as GStreamer hears it.
struct SourceSpec {
  SourceKind kind = SourceKind::kTest;
  std::string text;              ///< As it was given.
  std::string description = {};  ///< For gst_parse_bin_from_description(); ends in raw video.
  std::string launch = {};       ///< The same for a gst-launch line; empty = the description.
  std::string preparation = {};  ///< Commands of a shell that this needs before; empty = none.
  bool is_live = false;  ///< It has no end, cannot be stopped, and comes back when it drops.
  /// The pictures of a folder under numbered names, while a source needs them.
  std::shared_ptr<const std::filesystem::path> numbered = {};
};

/// Frames a second, as a fraction.
struct FrameRate {
  int n = 30;
  int d = 1;
};

/// Understands `10`, `29.97` and `30000/1001`. Throws std::invalid_argument where it is no rate
/// above 0 and up to 1000.
[[nodiscard]] FrameRate parse_rate(const std::string& text);

/// Text as a value in a gst-launch line.
[[nodiscard]] std::string quoted(const std::string& text);

/// Understands `test:SCENE`, a file, `/dev/videoN`, a URI, a folder of pictures, or a piece of a
/// gst-launch line in brackets: `[v4l2src ! jpegdec]`.
///
/// Throws std::invalid_argument that says what is wrong: no such scene (and which there are), file,
/// camera or picture, no right to read it, a piece of a line that cannot be parsed, a frame rate
/// for anything but a folder. Opens nothing.
/// @param rate  Of a folder of pictures; 30 where it is not given.
[[nodiscard]] SourceSpec parse_source(const std::string& text,
                                      std::optional<FrameRate> rate = std::nullopt);

}  // namespace live
