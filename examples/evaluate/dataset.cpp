// SPDX-License-Identifier: MIT
#include "examples/evaluate/dataset.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <stdexcept>

#include "examples/evaluate/picture_reader.hpp"
#include "examples/evaluate/rows.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

void check_axes(const Row& row, const ellipse::Ellipse& e) {
  if (!(e.semi_major >= e.semi_minor && e.semi_minor > 0.0)) {
    row.fail("the axes must be major >= minor > 0");
  }
}

Truth truth_of_csv(const Row& row) {
  Truth truth;
  int empty = 0;
  for (const char* column : {"cx", "cy", "semi_major", "semi_minor", "angle_rad"}) {
    empty += row.text(column).empty() ? 1 : 0;
  }
  if (empty == 5) return truth;
  if (empty > 0) row.fail("has a part of an ellipse only");
  truth.target = ellipse::Ellipse{row.number("cx"),
                                  row.number("cy"),
                                  row.number("semi_major"),
                                  row.number("semi_minor"),
                                  row.number("angle_rad")};
  check_axes(row, *truth.target);
  truth.visible_fraction = row.optional_number("visible_fraction");
  const double visible = truth.visible_fraction.value_or(1.0);
  if (visible < 0.0 || visible > 1.0) row.fail("visible_fraction must be from 0 to 1");
  return truth;
}

// The published form: full axes, width <= height, the angle is that of the width [degrees].
Truth truth_of_published(const Row& row) {
  Truth truth;
  if (row.number("HasTarget") == 0.0) return truth;
  truth.is_labelled = row.number("TargetWidth") >= 0.0;
  if (!truth.is_labelled) return truth;
  const double major_rad = (row.number("TargetAngle") + 90.0) * std::numbers::pi / 180.0;
  truth.target = ellipse::Ellipse{row.number("TargetCenterX"),
                                  row.number("TargetCenterY"),
                                  row.number("TargetHeight") / 2.0,
                                  row.number("TargetWidth") / 2.0,
                                  std::remainder(major_rad, std::numbers::pi)};
  check_axes(row, *truth.target);
  return truth;
}

// frame9 before frame10: a run of digits counts by its value.
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

// By the names of data set and sequence.
using FramesBySequence = std::map<std::pair<std::string, std::string>, std::vector<Frame>>;

constexpr std::int64_t kFrameNs = 33'333'333;
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
  explicit Reader(const fs::path& folder) : folder_(fs::canonical(folder)) {}

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
      throw std::runtime_error(folder_.string() + ": holds neither gt.csv nor ground_truth.txt");
    }
    if (frames_.empty() && dataset_.problems.empty()) {
      throw std::runtime_error(folder_.string() + ": its table names no picture");
    }
    note_images_without_rows();
    collect();
    return std::move(dataset_);
  }

 private:
  void read_csv(const fs::path& file) {
    const auto use = [&](const Row& row) {
      const fs::path image = named(row, folder_ / row.text("image"));
      Frame frame;
      frame.image = image;
      frame.truth = truth_of_csv(row);
      frame.conditions = {row.optional_number("noise"), row.optional_number("crumple")};
      frame.pts_ns = static_cast<std::int64_t>(row.optional_number("pts_ns").value_or(kNoTime));
      add(row, std::move(frame), row.has("dataset") ? row.text("dataset") : own_name());
    };
    for_each_row(file, ',', use, [&](const std::string& problem) { lose(problem); });
  }

  void read_published(const fs::path& file) {
    const auto use = [&](const Row& row) {
      Frame frame;
      frame.image = named(row, file.parent_path() / row.text("Filename"));
      frame.truth = truth_of_published(row);
      frame.pts_ns = kNoTime;
      add(row, std::move(frame), own_name());
    };
    for_each_row(file, '\t', use, [&](const std::string& problem) { lose(problem); });
  }

  void lose(const std::string& problem) {
    dataset_.problems.push_back(problem);
    ++dataset_.missing_frames;
  }

  [[nodiscard]] std::string own_name() const { return folder_.filename().string(); }

  // Also an image whose line is broken has a line.
  fs::path named(const Row& row, const fs::path& image) {
    const bool is_new = named_.insert(image.lexically_normal()).second;
    if (!is_new) row.fail("image " + image.string() + " has a line before");
    return image;
  }

  void add(const Row& row, Frame frame, const std::string& dataset) {
    if (!fs::exists(frame.image)) row.fail("image " + frame.image.string() + " is not there");
    const std::string sequence = sequence_of(frame.image);
    frame.name = sequence + "/" + frame.image.filename().string();
    frames_[{dataset, sequence}].push_back(std::move(frame));
  }

  // A sequence is a folder of pictures, named by its path inside the data set.
  [[nodiscard]] std::string sequence_of(const fs::path& image) const {
    const fs::path folder = image.parent_path().lexically_normal();
    const std::string inside = folder.lexically_relative(folder_).generic_string();
    if (inside == ".") return own_name();
    return inside.starts_with("images/") ? inside.substr(7) : inside;
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
        dataset_.problems.push_back(entry.path().string() + ": has no line in the table");
      }
    }
  }

  void collect() {
    const auto pictures = std::make_shared<FilePictures>();
    for (auto& [names, list] : frames_) {
      std::stable_sort(list.begin(), list.end(), [](const Frame& a, const Frame& b) {
        return natural_less(a.name, b.name);
      });
      for (std::size_t i = 0; i < list.size(); ++i) {
        list[i].number = i;
        if (list[i].pts_ns == kNoTime) list[i].pts_ns = static_cast<std::int64_t>(i) * kFrameNs;
      }
      dataset_.sequences.push_back({names.first, names.second, std::move(list), pictures});
    }
  }

  fs::path folder_;
  FramesBySequence frames_;
  std::set<fs::path> named_;
  Dataset dataset_;
};

void write_row(std::ostream& out,
               const fs::path& image,
               const Frame& frame,
               const std::string& dataset) {
  const auto number = [&](const std::optional<double>& value) {
    out << ',';
    if (value) out << *value;
  };
  const auto& target = frame.truth.target;
  out << image.generic_string();
  if (target) {
    for (const double value :
         {target->cx, target->cy, target->semi_major, target->semi_minor, target->angle_rad}) {
      number(value);
    }
  } else {
    out << ",,,,,";
  }
  number(frame.truth.visible_fraction);
  out << ',' << frame.pts_ns;
  number(frame.conditions.noise);
  number(frame.conditions.crumple);
  out << ',' << dataset << '\n';
}

void check_written(std::ofstream& out, const fs::path& file) {
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": " + error.message());
}

}  // namespace

Dataset read_dataset(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw std::runtime_error(folder.string() + ": is no folder that can be read");
  }
  return Reader(folder).read();
}

void write_dataset(const std::vector<Sequence>& sequences,
                   const fs::path& folder,
                   const std::function<bool(const Frame&)>& advance) {
  make_folder(folder);
  const fs::path table = folder / "gt.csv";
  std::ofstream out(table);
  out.precision(17);
  out << "image,cx,cy,semi_major,semi_minor,angle_rad,visible_fraction,pts_ns,noise,crumple,"
         "dataset\n";
  for (const Sequence& sequence : sequences) {
    make_folder(folder / "images" / sequence.name);
    for (const Frame& frame : sequence.frames) {
      const fs::path image = fs::path("images") / frame.name;
      if (!cv::imwrite((folder / image).string(), sequence.pictures->picture(frame))) {
        throw std::runtime_error((folder / image).string() + ": cannot be written");
      }
      write_row(out, image, frame, sequence.dataset);
      if (!advance(frame)) return check_written(out, table);
    }
  }
  check_written(out, table);
}

}  // namespace evaluate
