#pragma once  // SPDX-License-Identifier: MIT

#include <string>
#include <vector>

#include "examples/evaluate/limits.hpp"
#include "examples/evaluate/scenes.hpp"

namespace evaluate {

/// What was asked for on the command line.
struct Options {
  std::vector<std::string> datasets;
  std::vector<std::string> methods;
  std::vector<std::string> peers;
  std::vector<std::string> settings;
  std::vector<std::string> sweeps;
  std::vector<std::string> choices;
  std::string groups_file;
  bool fit_evidence = false;
  std::string evidence_file;
  bool leave_one_out = false;
  bool all_ellipses = false;
  ScenePace pace;
  double wild_seconds = 2.0;
  std::string rule = "iou";
  std::string ground_file;
  std::string frames_file;
  std::string json_file;
  std::string report_folder;
  std::string sweep_folder = "sweep";
  std::string dataset_folder;
  Limits limits;
  std::string command;
};

/// Does it: writes a data set, sweeps a property, leaves sources out, or compares methods.
/// @return The program's exit status: 1 where a method does not keep the limits, 2 where frames are
/// missing, 130 where it was interrupted.
/// Throws std::exception with a text for people, where it cannot.
int run(const Options& options);

/// Ends a run early, with what it has so far. To be called from a signal's handler.
void interrupt();

}  // namespace evaluate
