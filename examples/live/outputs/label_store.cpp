// SPDX-License-Identifier: MIT
#include "examples/live/outputs/label_store.hpp"

#include <gst/video/video.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "examples/live/json_writer.hpp"

namespace live {
namespace {

namespace fs = std::filesystem;

constexpr char kImages[] = "images/labelled";

std::string name_of(int number) {
  std::array<char, 32> name;
  std::snprintf(name.data(), name.size(), "%06d.png", number);
  return std::string(kImages) + "/" + name.data();
}

void write_png(const Frame& frame, const fs::path& file) {
  GstCaps* caps = gst_caps_new_empty_simple("image/png");
  const Ref<GstCaps> png(caps);
  GError* problem = nullptr;
  const Ref<GstSample> sample(
      gst_video_convert_sample(frame.sample.get(), caps, 5 * GST_SECOND, &problem));
  if (problem != nullptr) {
    const Ref<GError> error(problem);
    throw std::runtime_error(file.string() + ": " + error->message);
  }
  GstMapInfo map;
  GstBuffer* buffer = gst_sample_get_buffer(sample.get());
  if (!gst_buffer_map(buffer, &map, GST_MAP_READ))
    throw std::runtime_error("cannot map the picture");
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(map.data), static_cast<std::streamsize>(map.size));
  gst_buffer_unmap(buffer, &map);
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

LabelStore::LabelStore(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_ / kImages, error);
  if (error) throw std::runtime_error(folder_.string() + ": " + error.message());
  while (fs::exists(folder_ / name_of(next_))) ++next_;
}

std::string LabelStore::add(const Frame& frame, const std::optional<ellipse::Ellipse>& target) {
  const std::string name = name_of(next_);
  write_png(frame, folder_ / name);
  const fs::path table = folder_ / "gt.csv";
  const bool is_new = !fs::exists(table);
  std::string row =
      is_new ? "image,cx,cy,semi_major,semi_minor,angle_rad,visible_fraction,pts_ns\n" : "";
  row += name;
  if (target) {
    for (const double value :
         {target->cx, target->cy, target->semi_major, target->semi_minor, target->angle_rad}) {
      row.append(1, ',').append(json_number(value));
    }
    row.append(1, ',').append(
        json_number(ellipse::visible_fraction(*target, frame.width, frame.height)));
  } else {
    row += ",,,,,,";
  }
  row.append(1, ',').append(std::to_string(frame.pts)).append(1, '\n');
  std::ofstream out(table, std::ios::app);
  if (!(out << row).flush()) throw std::runtime_error(table.string() + ": cannot be written");
  ++next_;
  return name;
}

}  // namespace live
