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
  if (row.text("cx").empty()) return truth;
  truth.target = ellipse::Ellipse{row.number("cx"),
                                  row.number("cy"),
                                  row.number("semi_major"),
                                  row.number("semi_minor"),
                                  row.number("angle_rad")};
  check_axes(row, *truth.target);
  truth.visible_fraction = row.optional_number("visible_fraction");
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

using FramesBySequence = std::map<std::string, std::vector<Frame>>;

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
      const fs::path image = named(folder_ / row.text("image"));
      const Conditions conditions{row.optional_number("noise"), row.optional_number("crumple")};
      add(row, image, truth_of_csv(row), conditions);
    };
    for_each_row(file, ',', use, [&](const std::string& problem) { lose(problem); });
  }

  void read_published(const fs::path& file) {
    const auto use = [&](const Row& row) {
      const fs::path image = named(file.parent_path() / row.text("Filename"));
      add(row, image, truth_of_published(row), {});
    };
    for_each_row(file, '\t', use, [&](const std::string& problem) { lose(problem); });
  }

  void lose(const std::string& problem) {
    dataset_.problems.push_back(problem);
    ++dataset_.missing_frames;
  }

  // Also an image whose line is broken has a line.
  fs::path named(const fs::path& image) {
    named_.insert(image.lexically_normal());
    return image;
  }

  void add(const Row& row, const fs::path& image, const Truth& truth, const Conditions& with) {
    if (!fs::exists(image)) row.fail("image " + image.string() + " is not there");
    const std::string sequence = sequence_of(image);
    Frame frame{sequence + "/" + image.filename().string(), image, 0, truth, with};
    frames_[sequence].push_back(std::move(frame));
  }

  // A sequence is a folder of pictures, named by its path inside the data set.
  [[nodiscard]] std::string sequence_of(const fs::path& image) const {
    const fs::path folder = image.parent_path().lexically_normal();
    const std::string inside = folder.lexically_relative(folder_).generic_string();
    if (inside == ".") return folder_.filename().string();
    return inside.starts_with("images/") ? inside.substr(7) : inside;
  }

  void note_images_without_rows() {
    std::set<fs::path> folders;
    for (const fs::path& image : named_) folders.insert(image.parent_path());
    for (const fs::path& folder : folders) {
      if (!fs::is_directory(folder)) continue;
      for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        const bool is_picture = extension == ".jpg" || extension == ".jpeg" || extension == ".png";
        if (!is_picture || named_.contains(entry.path().lexically_normal())) continue;
        dataset_.problems.push_back(entry.path().string() + ": has no line in the table");
      }
    }
  }

  void collect() {
    const auto pictures = std::make_shared<FilePictures>();
    for (auto& [name, list] : frames_) {
      std::stable_sort(list.begin(), list.end(), [](const Frame& a, const Frame& b) {
        return natural_less(a.name, b.name);
      });
      for (std::size_t i = 0; i < list.size(); ++i) list[i].number = i;
      dataset_.sequences.push_back({folder_.filename().string(), name, std::move(list), pictures});
    }
  }

  fs::path folder_;
  FramesBySequence frames_;
  std::set<fs::path> named_;
  Dataset dataset_;
};

void write_row(std::ostream& out, const fs::path& image, const Frame& frame) {
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
  number(frame.conditions.noise);
  number(frame.conditions.crumple);
  out << '\n';
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
  fs::create_directories(folder);
  const fs::path table = folder / "gt.csv";
  std::ofstream out(table);
  out.precision(17);
  out << "image,cx,cy,semi_major,semi_minor,angle_rad,visible_fraction,noise,crumple\n";
  for (const Sequence& sequence : sequences) {
    fs::create_directories(folder / "images" / sequence.name);
    for (const Frame& frame : sequence.frames) {
      const fs::path image = fs::path("images") / frame.name;
      if (!cv::imwrite((folder / image).string(), sequence.pictures->picture(frame))) {
        throw std::runtime_error((folder / image).string() + ": cannot be written");
      }
      write_row(out, image, frame);
      if (!advance(frame)) break;
    }
  }
  if (!out.flush()) throw std::runtime_error(table.string() + ": cannot be written");
}

}  // namespace evaluate
