// SPDX-License-Identifier: MIT
//
// ellipse-landing: lands a simulated multirotor on a moving platform, guided by ellipsetrack or a
// peer.
#include <gst/gst.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "examples/landing/method.hpp"
#include "examples/landing/report.hpp"
#include "examples/landing/video.hpp"
#include "examples/option_checks.hpp"

namespace {

namespace fs = std::filesystem;
using landing::Course;
using landing::Flight;
using landing::Landing;

struct Options {
  int runs = 12;
  std::vector<double> speeds = {4.2};
  std::uint64_t seed = 1;
  double gust = 3.0;
  int width = 640;
  std::vector<std::string> methods = {"arcs+edges"};
  int jobs = 0;
  std::string video;
  std::string report;
};

// The seed also selects the course and the lighting condition.
std::vector<Landing> planned(const Options& options) {
  const auto conditions = landing::condition_names();
  std::vector<Landing> landings;
  for (const std::string& method : options.methods) {
    for (const double speed : options.speeds) {
      for (int run = 0; run < options.runs; ++run) {
        Flight flight;
        flight.seed = options.seed + static_cast<std::uint64_t>(run);
        flight.speed = speed;
        flight.course = static_cast<Course>(flight.seed % 3);
        flight.condition = conditions[flight.seed % conditions.size()];
        flight.method = method;
        flight.vehicle.gust = options.gust;
        flight.rig.camera = flight.rig.camera.resized(options.width, options.width * 9 / 16);
        landings.push_back({flight, {}});
      }
    }
  }
  return landings;
}

// Flies all landings in parallel, one per processor. They are independent, so the order has no
// effect.
void fly_all(std::vector<Landing>& landings, int jobs) {
  std::atomic<std::size_t> next = 0;
  std::size_t done = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto work = [&] {
    while (true) {
      const std::size_t mine = next++;
      if (mine >= landings.size()) return;
      try {
        landings[mine].outcome = fly(landings[mine].flight);
      } catch (...) {
        const std::scoped_lock lock(mutex);
        failure = std::current_exception();
        next = landings.size();
        return;
      }
      const std::scoped_lock lock(mutex);
      std::cerr << "\r" << ++done << " of " << landings.size() << " landings" << std::flush;
    }
  };
  {
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> workers;
    for (unsigned i = 0; i < (jobs > 0 ? static_cast<unsigned>(jobs) : processors); ++i) {
      workers.emplace_back(work);
    }
  }
  std::cerr << '\n';
  if (failure) std::rethrow_exception(failure);
}

// Checks before hours of simulation that the outputs can be written. Devices and pipes are not
// opened.
void check_can_be_written(const std::string& option, const fs::path& path, const fs::path& file) {
  std::error_code ignored;
  const bool is_new = !fs::exists(file, ignored);
  if (!is_new && !fs::is_regular_file(file, ignored) && !fs::is_directory(file, ignored)) return;
  if (!std::ofstream(file, std::ios::app)) {
    throw std::runtime_error(option + " " + path.string() + ": cannot be written");
  }
  if (is_new) fs::remove(file, ignored);
}

void check_outputs(const Options& options) {
  if (!options.video.empty()) check_can_be_written("--video", options.video, options.video);
  if (options.report.empty()) return;
  std::error_code ignored;  // a missing folder is reported below
  fs::create_directories(options.report, ignored);
  check_can_be_written("--report", options.report, fs::path(options.report) / "report.md");
}

void make_video(const Flight& flight, const std::string& file) {
  try {
    landing::film(flight, file);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("--video " + file + ": " + error.what());
  }
}

void run(const Options& options, const std::string& command) {
  check_outputs(options);
  for (const std::string& method : options.methods) landing::check_method(method);
  std::vector<Landing> landings = planned(options);
  fly_all(landings, options.jobs);
  print(std::cout, outcome_table(landings));
  print(std::cout, unseen_table(landings));
  if (!options.report.empty()) write_report(landings, command, options.report);
  if (!options.video.empty()) make_video(landings.front().flight, options.video);
}

}  // namespace

int main(int argc, char** argv) {
  gst_init(&argc, &argv);
  Options options;
  CLI::App app{"Lands a simulated multirotor on a moving platform, guided by ellipsetrack."};
  app.name("ellipse-landing");
  app.add_option("--runs", options.runs, "Number of landings per method and speed")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option(
         "--speed", options.speeds, "Speed of the platform [m/s]; several separated by commas")
      ->delimiter(',')
      ->check(finite_number() & CLI::Range(0.0, 12.0))
      ->capture_default_str();
  app.add_option(
         "--seed", options.seed, "Random seed of the first landing; each landing has its own")
      ->check(non_negative_integer())
      ->capture_default_str();
  app.add_option("--gust", options.gust, "Root mean square of the wind speed [m/s]")
      ->check(finite_number() & CLI::Range(0.0, 10.0))
      ->capture_default_str();
  app.add_option("--width", options.width, "Width of the camera's frames [px]")
      ->check(CLI::Range(160, 1920))
      ->capture_default_str();
  app.add_option("--methods",
                 options.methods,
                 "detector+tracking, apriltag or whycon; several separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--jobs", options.jobs, "Number of parallel landings; 0 = number of processors")
      ->check(non_negative_integer());
  app.add_option("--video", options.video, "Write the first landing to this Matroska file");
  app.add_option("--report", options.report, "Folder for tables and plots");
  CLI11_PARSE(app, argc, argv);
  std::string command = "ellipse-landing";
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  try {
    run(options, command);
  } catch (const std::exception& error) {
    std::cerr << "ellipse-landing: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
