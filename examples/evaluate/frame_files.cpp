// SPDX-License-Identifier: MIT
#include "examples/evaluate/frame_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>

#include "examples/evaluate/dataset_writer.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

bool has_no_files(const Sequence& sequence) {
  return std::ranges::any_of(sequence.frames,
                             [](const Frame& frame) { return frame.image.empty(); });
}

}  // namespace

std::size_t frames_of(const std::vector<Sequence>& sequences) {
  std::size_t frames = 0;
  for (const Sequence& sequence : sequences) frames += sequence.frames.size();
  return frames;
}

std::size_t frames_without_files(const std::vector<Sequence>& sequences) {
  std::size_t frames = 0;
  for (const Sequence& sequence : sequences) {
    frames += has_no_files(sequence) ? sequence.frames.size() : 0;
  }
  return frames;
}

void write_files(std::vector<Sequence>& sequences,
                 const fs::path& folder,
                 const std::function<bool(const Frame&)>& advance) {
  std::vector<std::vector<Sequence*>> parts;
  std::map<std::string, std::size_t> uses;
  for (Sequence& sequence : sequences) {
    if (!has_no_files(sequence)) continue;
    const std::size_t part = uses[sequence.name]++;
    parts.resize(std::max(parts.size(), part + 1));
    parts[part].push_back(&sequence);
  }
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const fs::path own = part == 0 ? folder : folder / std::to_string(part + 1);
    std::vector<Sequence> written;
    for (const Sequence* sequence : parts[part]) written.push_back(*sequence);
    write_dataset(written, own, advance);
    for (Sequence* sequence : parts[part]) {
      for (Frame& frame : sequence->frames) frame.image = own / "images" / frame.name;
    }
  }
}

TemporaryFolder::TemporaryFolder() : path_(fs::temp_directory_path() / "ellipse-evaluate-XXXXXX") {
  std::string name = path_.string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::runtime_error(name + ": cannot create a temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace evaluate
