// SPDX-License-Identifier: MIT
//
// Decodes files with corrupted bytes. A decoder may end the stream with an error; the frames that
// it outputs reach ellipsetrack.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/scene/random.hpp"
#include "tests/gst/verdicts.hpp"

namespace {

using support::contents_of;
using support::run_pipeline;
using support::TemporaryFolder;
using support::Verdict;
using support::Verdicts;

constexpr int kFrames = 30;
const std::string kSource = "ellipsetestsrc num-buffers=" + std::to_string(kFrames) +
                            " ! video/x-raw,format=I420,width=320,height=240 ! ";

void write(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string broken(std::string bytes, int flips, ellipse::Random& random) {
  for (int i = 0; i < flips && !bytes.empty(); ++i) {
    char& byte = bytes.at(static_cast<std::size_t>(random.below(static_cast<int>(bytes.size()))));
    byte = static_cast<char>(byte ^ static_cast<char>(1 + random.below(255)));
  }
  return bytes;
}

// @return The number of frames at the sink; fails if the pipeline neither ends nor reports an
// error.
std::size_t frames_of(const std::string& pipeline) {
  Verdicts verdicts;
  const std::string failure =
      run_pipeline(pipeline + " ! ellipsetrack overlay=ellipse+label ! fakesink name=out",
                   [&](GstElement* element) { verdicts.watch(element); });
  EXPECT_NE(failure, "timed out");
  return verdicts.all().size();
}

TEST(BrokenStream, CorruptedPicturesPass) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_pipeline(kSource + "jpegenc ! multifilesink location=" + folder.file("%03d.jpg")),
            "");
  ellipse::Random random(1);
  for (int i = 0; i < kFrames; ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "%03d.jpg", i);
    write(folder.file(name), broken(contents_of(folder.file(name)), 1 + i, random));
  }
  // One pipeline per picture: a decoder that fails on one never reads the next.
  std::size_t frames = 0;
  for (int i = 0; i < kFrames; ++i) {
    const std::string index = std::to_string(i);
    frames += frames_of("multifilesrc location=" + folder.file("%03d.jpg") +
                        " start-index=" + index + " stop-index=" + index +
                        " caps=image/jpeg,framerate=30/1 ! jpegdec ! videoconvert");
  }
  EXPECT_GE(frames, std::size_t{kFrames / 3});
  EXPECT_GE(frames_of("multifilesrc location=" + folder.file("%03d.jpg") +
                      " caps=image/jpeg,framerate=30/1 ! jpegdec max-errors=-1 ! videoconvert"),
            std::size_t{1});
}

TEST(BrokenStream, CorruptedVideoPasses) {
  const TemporaryFolder folder;
  const std::string made = run_pipeline(
      kSource +
      "x264enc tune=zerolatency key-int-max=10 ! video/x-h264,stream-format=byte-stream "
      "! filesink location=" +
      folder.file("whole.h264"));
  if (made.starts_with(support::Pipeline::kNotInstalled)) GTEST_SKIP() << made;
  ASSERT_EQ(made, "");
  const std::string whole = contents_of(folder.file("whole.h264"));
  const std::string decoder =
      "filesrc location=" + folder.file("broken.h264") + " ! h264parse ! avdec_h264 ! videoconvert";
  write(folder.file("broken.h264"), whole);
  ASSERT_EQ(frames_of(decoder), std::size_t{kFrames});  // without corruption
  ellipse::Random random(2);
  std::size_t frames = 0;
  for (const int flips : {1, 3, 10, 30, 100, 300, 1000}) {
    for (int round = 0; round < 4; ++round) {
      write(folder.file("broken.h264"), broken(whole, flips, random));
      frames += frames_of(decoder);
    }
  }
  EXPECT_GE(frames, std::size_t{4 * kFrames});
}

}  // namespace
