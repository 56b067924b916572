// SPDX-License-Identifier: MIT
#include "examples/evaluate/dataset_writer.hpp"

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace evaluate {
namespace {

namespace fs = std::filesystem;

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
