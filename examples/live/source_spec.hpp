#pragma once  // SPDX-License-Identifier: MIT

#include <filesystem>
#include <memory>
#include <string>

namespace live {

enum class SourceKind { kTest, kFile, kDevice, kUri, kFolder, kFragment };

[[nodiscard]] const char* nick_of(SourceKind kind);

/// Where the video comes from, as a person says it and as GStreamer hears it.
struct SourceSpec {
  SourceKind kind = SourceKind::kTest;
  std::string text;              ///< As it was given.
  std::string description = {};  ///< For gst_parse_bin_from_description(); ends in raw video.
  bool is_live = false;  ///< It has no end, cannot be stopped, and comes back when it drops.
  /// The pictures of a folder under numbered names, while a source needs them.
  std::shared_ptr<const std::filesystem::path> numbered = {};
};

/// Understands `test:SCENE`, a file, `/dev/videoN`, a URI, a folder of pictures, or a piece of a
/// gst-launch line in brackets: `[v4l2src ! jpegdec]`.
///
/// Throws std::invalid_argument that says what is wrong: no such scene (and which there are), file,
/// camera or picture, no right to read it, a piece of a line that cannot be parsed. Opens nothing.
[[nodiscard]] SourceSpec parse_source(const std::string& text);

}  // namespace live
