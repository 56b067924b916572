// SPDX-License-Identifier: MIT
//
// Processes a number of equal frames for tools that count instructions: the difference between two
// runs is the cost of the additional frames.
//   frame-cost none|edges WIDTH HEIGHT FRAMES
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/tracking/tracker.hpp"
#include "tests/support/integer_disc.hpp"

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: frame-cost none|edges WIDTH HEIGHT FRAMES\n");
    return 2;
  }
  const int width = std::atoi(argv[2]);
  const int height = std::atoi(argv[3]);
  const int frames = std::atoi(argv[4]);
  ellipse::TrackerSettings settings;
  settings.tracking =
      argv[1] == std::string("none") ? ellipse::TrackingMode::kNone : ellipse::TrackingMode::kEdges;
  ellipse::Tracker tracker(settings);
  const support::IntegerDisc disc{width / 2, height / 2, width / 8, height / 6};
  const support::GrayPicture picture = disc.draw(width, height, 6);
  int found = 0;
  for (int i = 0; i < frames; ++i) {
    found += tracker.process(picture.view(), i * 1'000'000'000LL / 30) ? 1 : 0;
  }
  return found == frames ? 0 : 1;
}
