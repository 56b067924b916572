#pragma once  // SPDX-License-Identifier: MIT

#include <string>
#include <vector>

#include "examples/evaluate/limits.hpp"
#include "examples/evaluate/scenes.hpp"

namespace evaluate {

/// The options of the command line.
struct Options {
  std::vector<std::string> datasets;
  std::vector<std::string> variants;
  std::vector<std::string> methods;
  std::vector<std::string> peers;
  std::vector<std::string> settings;
  int finest_scale = 1;
  std::vector<std::string> sweeps;
  std::vector<std::string> choices;
  std::string groups_file;
  bool fit_evidence = false;
  std::string evidence_file;
  bool leave_one_out = false;
  bool all_ellipses = false;
  ScenePace pace;
  double pictures_per_second = 30.0;
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

/// Runs the requested action: writes a data set, sweeps a property, leaves sources out, or compares
/// methods.
/// @return The exit status: 1 if a method violates a limit, 2 if frames are missing, 130 if
/// interrupted.
///
/// Throws std::exception with a message for the user.
int run(const Options& options);

/// Stops a run early, with the results so far. Async-signal-safe.
void interrupt();

}  // namespace evaluate
