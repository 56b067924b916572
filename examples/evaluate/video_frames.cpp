// SPDX-License-Identifier: MIT
#include "examples/evaluate/video_frames.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "examples/evaluate/picture_reader.hpp"
#include "examples/evaluate/video_reader.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

// The number at the end of a name, such as 12 in frame_0012; nullopt if there is none.
std::optional<std::size_t> number_at_end(const std::string& stem) {
  const std::size_t before = stem.find_last_not_of("0123456789");
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(stem.data() + begin, stem.data() + stem.size(), number);
  return error == std::errc{} ? std::optional(number) : std::nullopt;
}

class VideoPictures : public PictureSource {
 public:
  explicit VideoPictures(const fs::path& file) : reader_(file) {}

  cv::Mat picture(const Frame& frame) override {
    if (!frame.image.empty()) return files_.read(frame.image);
    const auto number = number_at_end(fs::path(frame.name).stem().string());
    return reader_.read(number.value());
  }

 private:
  VideoReader reader_;
  PictureReader files_;
};

}  // namespace

VideoFrames::Video* VideoFrames::video_of_folder(const fs::path& image_folder) {
  const auto [entry, is_new] = videos_.try_emplace(image_folder);
  std::optional<Video>& video = entry->second;
  if (is_new) {
    const auto file = video_of(dataset_folder_, image_folder.filename().string());
    if (file) video = Video{*file, {}, {}, ""};
    try {
      if (file) video->times_ns = VideoReader(*file).frame_times_ns();
    } catch (const std::runtime_error& error) {
      video->error = error.what();
    }
    if (file) video->is_named.resize(video->times_ns.size());
  }
  return video ? &*video : nullptr;
}

std::optional<VideoFrames::VideoFrame> VideoFrames::find(const fs::path& image) {
  Video* video = video_of_folder(image.parent_path().lexically_normal());
  if (video == nullptr) return std::nullopt;
  if (!video->error.empty()) throw std::runtime_error(video->error);
  const auto number = number_at_end(image.stem().string());
  if (!number || *number >= video->times_ns.size()) {
    throw std::runtime_error(image.string() + " is not one of the " +
                             std::to_string(video->times_ns.size()) + " frames of " +
                             video->file.string());
  }
  video->is_named[*number] = true;
  return VideoFrame{*number, video->times_ns[*number]};
}

std::shared_ptr<PictureSource> VideoFrames::pictures_of(const fs::path& image_folder) const {
  const auto found = videos_.find(image_folder.lexically_normal());
  if (found == videos_.end() || !found->second) return nullptr;
  return std::make_shared<VideoPictures>(found->second->file);
}

std::vector<std::string> VideoFrames::unnamed_frames() const {
  std::vector<std::string> lines;
  for (const auto& [folder, video] : videos_) {
    if (!video) continue;
    const auto unnamed = std::count(video->is_named.begin(), video->is_named.end(), false);
    if (unnamed == 0) continue;
    lines.push_back(video->file.string() + ": " + std::to_string(unnamed) + " of its " +
                    std::to_string(video->is_named.size()) + " frames are not in the table");
  }
  return lines;
}

}  // namespace evaluate
