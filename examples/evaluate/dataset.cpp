// SPDX-License-Identifier: MIT
#include "examples/evaluate/dataset.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <system_error>

#include "examples/evaluate/picture_reader.hpp"
#include "examples/evaluate/rows.hpp"
#include "examples/evaluate/truth_rows.hpp"
#include "examples/evaluate/video_frames.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

// Natural order: digits compare by value, so frame9 precedes frame10.
bool natural_less(const std::string& a, const std::string& b) {
  const auto parts = [](const std::string& s) {
    std::vector<std::pair<unsigned long long, std::string>> result(1);
    for (std::size_t i = 0; i < s.size();) {
      unsigned long long value = 0;
      const auto [end, error] = std::from_chars(s.data() + i, s.data() + s.size(), value);
      if (error == std::errc{}) {
        result.emplace_back(value, "");
        i = static_cast<std::size_t>(end - s.data());
      } else {
        result.back().second += s[i++];
      }
    }
    return result;
  };
  return parts(a) < parts(b);
}

// Names of data set and sequence.
using SequenceKey = std::pair<std::string, std::string>;
using FramesBySequence = std::map<SequenceKey, std::vector<Frame>>;

constexpr std::int64_t kNoTime = -1;

class FilePictures : public PictureSource {
 public:
  cv::Mat picture(const Frame& frame) override { return reader_.read(frame.image); }

 private:
  PictureReader reader_;
};

// Reads one folder with its tables.
class Reader {
 public:
  Reader(const fs::path& folder, double frames_per_second)
      : folder_(fs::canonical(folder)), frame_ns_(1e9 / frames_per_second), videos_(folder_) {}

  Dataset read() {
    bool has_table = fs::exists(folder_ / "gt.csv");
    if (has_table) {
      read_csv(folder_ / "gt.csv");
    } else {
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
        if (entry.path().filename() != "ground_truth.txt") continue;
        has_table = true;
        read_published(entry.path());
      }
    }
    if (!has_table) {
      throw std::runtime_error(folder_.string() + ": contains neither gt.csv nor ground_truth.txt");
    }
    if (frames_.empty() && dataset_.problems.empty()) {
      throw std::runtime_error(folder_.string() + ": its table lists no picture");
    }
    read_ignored(folder_ / "ignore.txt");
    note_images_without_rows();
    collect();
    return std::move(dataset_);
  }

 private:
  // Indices of a frame.
  struct FrameIndex {
    SequenceKey sequence;
    std::size_t index = 0;
  };

  void read_csv(const fs::path& file) {
    const auto use = [&](const Row& row) {
      Frame frame;
      frame.image = (folder_ / row.text("image")).lexically_normal();
      named_.insert(frame.image);
      frame.truth = truth_of_csv(row);
      if (Frame* before = find(frame.image)) return add_ellipse(row, *before, frame.truth);
      frame.conditions = {row.optional_number("noise"), row.optional_number("crumple")};
      frame.pts_ns = static_cast<std::int64_t>(row.optional_number("pts_ns").value_or(kNoTime));
      add(row, std::move(frame), row.has("dataset") ? row.text("dataset") : own_name());
    };
    for_each_row(file, ',', use, [&](const std::string& problem) { skip_row(problem); });
  }

  void read_published(const fs::path& file) {
    const auto use = [&](const Row& row) {
      Frame frame;
      frame.image = (file.parent_path() / row.text("Filename")).lexically_normal();
      if (!named_.insert(frame.image).second) {
        row.fail("image " + frame.image.string() + " is listed twice");
      }
      frame.truth = truth_of_published(row);
      frame.pts_ns = kNoTime;
      add(row, std::move(frame), own_name());
    };
    for_each_row(file, '\t', use, [&](const std::string& problem) { skip_row(problem); });
  }

  void skip_row(const std::string& problem) {
    dataset_.problems.push_back(problem);
    ++dataset_.missing_frames;
  }

  [[nodiscard]] std::string own_name() const { return folder_.filename().string(); }

  Frame* find(const fs::path& image) {
    const auto found = indices_.find(image);
    return found == indices_.end() ? nullptr
                                   : &frames_[found->second.sequence][found->second.index];
  }

  // Adds an ellipse from a further row of the same image.
  static void add_ellipse(const Row& row, Frame& frame, const Truth& truth) {
    if (!truth.target || !frame.truth.target) {
      row.fail("image " + frame.name + " has several lines, one of them without an ellipse");
    }
    for (const TrueEllipse& known : ellipses_of(frame.truth)) {
      if (known.ellipse == *truth.target) {
        row.fail("image " + frame.name + " lists the same ellipse twice");
      }
    }
    for (const TrueEllipse& one : ellipses_of(truth)) frame.truth.others.push_back(one);
  }

  void add(const Row& row, Frame frame, const std::string& dataset) {
    try {
      add(std::move(frame), dataset);
    } catch (const std::runtime_error& error) {
      row.fail(error.what());
    }
  }

  void add(Frame frame, const std::string& dataset) {
    const fs::path image = frame.image;
    if (!fs::exists(image)) {
      const auto video = videos_.find(image);
      if (!video) throw std::runtime_error("image " + image.string() + " does not exist");
      frame.image.clear();
      if (frame.pts_ns == kNoTime) frame.pts_ns = video->pts_ns;
    }
    const SequenceKey key{dataset, sequence_of(image)};
    frame.name = key.second + "/" + image.filename().string();
    folders_[key] = image.parent_path();
    indices_[image] = {key, frames_[key].size()};
    frames_[key].push_back(std::move(frame));
  }

  // The sequence is the image's folder, relative to the data set.
  [[nodiscard]] std::string sequence_of(const fs::path& image) const {
    const fs::path folder = image.parent_path().lexically_normal();
    const std::string inside = folder.lexically_relative(folder_).generic_string();
    if (inside == ".") return own_name();
    return inside.starts_with("images/") ? inside.substr(7) : inside;
  }

  // Reads the list of images that are processed but not judged. They need no row in the table.
  void read_ignored(const fs::path& file) {
    if (!fs::exists(file)) return;
    std::ifstream in(file);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (line.empty() || line.front() == '#') continue;
      try {
        ignore((folder_ / line).lexically_normal());
      } catch (const std::runtime_error& error) {
        dataset_.problems.push_back(file.string() + ":" + std::to_string(number) + ": " +
                                    error.what());
      }
    }
    if (in.bad()) throw std::runtime_error(file.string() + ": cannot be read");
  }

  void ignore(const fs::path& image) {
    named_.insert(image);
    if (find(image) == nullptr) {
      Frame frame;
      frame.image = image;
      frame.pts_ns = kNoTime;
      add(std::move(frame), own_name());
    }
    find(image)->truth.is_labelled = false;
  }

  void note_images_without_rows() {
    std::set<fs::path> folders;
    for (const fs::path& image : named_) folders.insert(image.parent_path());
    for (const fs::path& folder : folders) {
      if (!fs::is_directory(folder)) continue;
      for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        if (!PictureReader::is_picture(entry.path()) ||
            named_.contains(entry.path().lexically_normal()))
          continue;
        dataset_.problems.push_back(entry.path().string() + ": not in the table");
      }
    }
    for (const std::string& line : videos_.unnamed_frames()) dataset_.problems.push_back(line);
  }

  void collect() {
    const auto files = std::make_shared<FilePictures>();
    for (auto& [key, list] : frames_) {
      std::stable_sort(list.begin(), list.end(), [](const Frame& a, const Frame& b) {
        return natural_less(a.name, b.name);
      });
      for (std::size_t i = 0; i < list.size(); ++i) {
        list[i].number = i;
        if (list[i].pts_ns == kNoTime) {
          list[i].pts_ns = std::llround(static_cast<double>(i) * frame_ns_);
        }
      }
      std::shared_ptr<PictureSource> pictures = files;
      if (std::ranges::any_of(list, [](const Frame& frame) { return frame.image.empty(); })) {
        pictures = videos_.pictures_of(folders_[key]);
      }
      dataset_.sequences.push_back({key.first, key.second, std::move(list), pictures});
    }
  }

  fs::path folder_;
  double frame_ns_;
  VideoFrames videos_;
  FramesBySequence frames_;
  std::map<SequenceKey, fs::path> folders_;
  std::map<fs::path, FrameIndex> indices_;  // by image
  std::set<fs::path> named_;
  Dataset dataset_;
};

}  // namespace

std::vector<TrueEllipse> ellipses_of(const Truth& truth) {
  std::vector<TrueEllipse> ellipses;
  if (truth.target) ellipses.push_back({*truth.target, truth.visible_fraction});
  ellipses.insert(ellipses.end(), truth.others.begin(), truth.others.end());
  return ellipses;
}

Dataset read_dataset(const fs::path& folder, double frames_per_second) {
  if (!fs::is_directory(folder)) {
    throw std::runtime_error(folder.string() + ": not a readable folder");
  }
  return Reader(folder, frames_per_second).read();
}

std::vector<fs::path> dataset_folders(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;  // a list of seeds may be longer than a file name
  if (fs::is_directory(folder, error) && !fs::exists(folder / "gt.csv")) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (fs::exists(entry.path() / "gt.csv")) folders.push_back(entry.path());
    }
  }
  std::sort(folders.begin(), folders.end());
  if (folders.empty()) folders.push_back(folder);
  return folders;
}

}  // namespace evaluate
