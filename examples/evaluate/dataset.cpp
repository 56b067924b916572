// SPDX-License-Identifier: MIT
#include "examples/evaluate/dataset.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <stdexcept>

namespace evaluate {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> fields(1);
  for (const char c : text) {
    if (c == separator) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

// One line of a table with a header, and where it stands.
class Row {
 public:
  Row(const fs::path& file,
      int line,
      const std::vector<std::string>& header,
      std::vector<std::string> fields)
      : file_(file), line_(line), header_(header), fields_(std::move(fields)) {
    if (fields_.size() == header_.size()) return;
    fail(std::to_string(fields_.size()) + " fields where the header has " +
         std::to_string(header_.size()));
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(file_.string() + ":" + std::to_string(line_) + ": " + what);
  }

  [[nodiscard]] bool has(const std::string& column) const {
    return std::find(header_.begin(), header_.end(), column) != header_.end();
  }

  [[nodiscard]] const std::string& text(const std::string& column) const {
    const auto found = std::find(header_.begin(), header_.end(), column);
    if (found == header_.end()) fail("no column \"" + column + "\"");
    return fields_[static_cast<std::size_t>(found - header_.begin())];
  }

  [[nodiscard]] double number(const std::string& column) const {
    const std::string& field = text(column);
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) {
      fail(column + " is \"" + field + "\", not a number");
    }
    return value;
  }

 private:
  const fs::path& file_;
  int line_;
  const std::vector<std::string>& header_;
  std::vector<std::string> fields_;
};

template <class Use>
void for_each_row(const fs::path& file, char separator, const Use& use) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<std::string> header;
  std::string text;
  for (int line = 1; std::getline(in, text); ++line) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (text.empty()) continue;
    if (header.empty()) {
      header = split(text, separator);
    } else {
      use(Row(file, line, header, split(text, separator)));
    }
  }
  if (header.empty()) throw std::runtime_error(file.string() + ": is empty");
}

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
  if (row.has("visible_fraction") && !row.text("visible_fraction").empty()) {
    truth.visible_fraction = row.number("visible_fraction");
  }
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

// A sequence is a folder of pictures, named by its path inside the data set.
std::string sequence_of(const fs::path& image, const fs::path& dataset) {
  const fs::path folder = image.parent_path().lexically_normal();
  const std::string inside = folder.lexically_relative(dataset).generic_string();
  if (inside == ".") return dataset.filename().string();
  return inside.starts_with("images/") ? inside.substr(7) : inside;
}

void add_frame(FramesBySequence& frames,
               const fs::path& dataset,
               const fs::path& image,
               const Truth& truth) {
  const std::string sequence = sequence_of(image, dataset);
  frames[sequence].push_back({image, sequence + "/" + image.filename().string(), truth});
}

void read_csv(const fs::path& file, const fs::path& dataset, FramesBySequence& frames) {
  for_each_row(file, ',', [&](const Row& row) {
    add_frame(frames, dataset, file.parent_path() / row.text("image"), truth_of_csv(row));
  });
}

void read_published(const fs::path& file, const fs::path& dataset, FramesBySequence& frames) {
  for_each_row(file, '\t', [&](const Row& row) {
    add_frame(frames, dataset, file.parent_path() / row.text("Filename"), truth_of_published(row));
  });
}

}  // namespace

std::vector<Sequence> read_dataset(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw std::runtime_error(folder.string() + ": is no folder that can be read");
  }
  const fs::path dataset = fs::canonical(folder);
  FramesBySequence frames;
  bool has_table = fs::exists(dataset / "gt.csv");
  if (has_table) {
    read_csv(dataset / "gt.csv", dataset, frames);
  } else {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(dataset)) {
      if (entry.path().filename() != "ground_truth.txt") continue;
      has_table = true;
      read_published(entry.path(), dataset, frames);
    }
  }
  if (!has_table) {
    throw std::runtime_error(folder.string() + ": holds neither gt.csv nor ground_truth.txt");
  }
  if (frames.empty()) throw std::runtime_error(folder.string() + ": its table names no picture");
  std::vector<Sequence> sequences;
  for (auto& [name, list] : frames) {
    std::stable_sort(list.begin(), list.end(), [](const Frame& a, const Frame& b) {
      return natural_less(a.name, b.name);
    });
    sequences.push_back({name, std::move(list)});
  }
  return sequences;
}

}  // namespace evaluate
