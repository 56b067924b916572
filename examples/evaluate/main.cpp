// SPDX-License-Identifier: MIT
//
// ellipse-evaluate: measures the tracker and its peers on data sets with ground truth, and prints
// the tables and figures of [Keipour2021] III.
#include <gst/gst.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <iostream>
#include <limits>
#include <opencv2/core.hpp>

#include "examples/evaluate/program.hpp"
#include "examples/evaluate/variants.hpp"
#include "examples/option_checks.hpp"

namespace evaluate {
namespace {

void on_interrupt(int /*signal*/) {
  interrupt();
  std::signal(SIGINT, SIG_DFL);  // a second Ctrl-C kills the program
}

CLI::Option* add_leave_one_out(CLI::App& app, Options& options, CLI::Option* datasets) {
  CLI::Option* choose = app.add_option("--choose",
                                       options.choices,
                                       "PROPERTY=VALUE:VALUE... or PROPERTY=FROM:TO:STEP; several "
                                       "options form a grid")
                            ->allow_extra_args(false);
  CLI::Option* leave = app.add_flag("--leave-one-out",
                                    options.leave_one_out,
                                    "For each data set: choose on all others, report on this one")
                           ->needs(datasets);
  choose->needs(leave);
  CLI::Option* fit =
      app.add_flag("--fit-evidence",
                   options.fit_evidence,
                   "Fit the evidence table of the detector arcs to the data sets; with "
                   "--leave-one-out to all but the one under test")
          ->needs(datasets)
          ->excludes(choose);
  app.add_option(
         "--out", options.evidence_file, "File for the evidence table; default: standard output")
      ->needs(fit)
      ->excludes(leave);
  app.add_option(
         "--groups",
         options.groups_file,
         "File of data sets to leave out together: lines GROUP: NAME NAME..., with * and ?; "
         "default: one group of airlab-*, one of all rendered data")
      ->needs(leave);
  return leave;
}

void add_options(CLI::App& app, Options& options) {
  CLI::Option* datasets = app.add_option(
      "DATASET",
      options.datasets,
      "Folders with gt.csv or ground_truth.txt, or folders of such folders; or rendered: "
      "scenes:SEEDS = all scenes of the catalog, scenes-NAME:SEEDS = one of them, "
      "distorted:SEEDS = all through distorting lenses, wild:SEEDS = random scenes, "
      "wild-frames:SEEDS = one frame of each, clutter:SEEDS = objects that resemble a pad. "
      "SEEDS is SEED, FROM-TO or a comma-separated list. Default: the rendered imitation of the "
      "paper's data set (\"twin\")");
  app.add_option("--seconds",
                 options.pace.seconds,
                 "Duration of each sequence of scenes, distorted and clutter [s]")
      ->capture_default_str()
      ->check(positive_number())
      ->needs(datasets);
  app.add_option("--wild-seconds", options.wild_seconds, "Duration of each sequence of wild [s]")
      ->capture_default_str()
      ->check(positive_number())
      ->needs(datasets);
  app.add_option(
         "--fps", options.pace.frames_per_second, "Frame rate of scenes, distorted and clutter")
      ->capture_default_str()
      ->check(positive_number())
      ->needs(datasets);
  app.add_option(
         "--picture-fps", options.pictures_per_second, "Frame rate of pictures without time stamps")
      ->capture_default_str()
      ->check(positive_number())
      ->needs(datasets);
  CLI::Option* variants = app.add_option("--variants",
                                         options.variants,
                                         "Comma-separated. Also evaluate altered copies of each "
                                         "data set: " +
                                             describe_variants())
                              ->delimiter(',')
                              ->needs(datasets);
  app.add_option(
         "--set", options.settings, "PROPERTY=VALUE of the detector or the tracker of ellipsetrack")
      ->allow_extra_args(false);
  app.add_option("--rule", options.rule, "Criterion for a correct answer")
      ->capture_default_str()
      ->check(CLI::IsMember({"iou", "published"}));
  CLI::Option* sweep =
      app.add_option("--sweep",
                     options.sweeps,
                     "PROPERTY=FROM:TO:STEP or PROPERTY=VALUE,...: evaluate each value")
          ->allow_extra_args(false);
  app.add_option("--sweep-dir", options.sweep_folder, "Folder for the CSV, SVG and PNG of sweeps")
      ->capture_default_str()
      ->needs(sweep);
  app.add_option("--ground", options.ground_file, "Picture of the ground in the twin's scenes")
      ->excludes(datasets);
  CLI::Option* leave = add_leave_one_out(app, options, datasets);
  CLI::Option* make = app.add_option("--make-dataset",
                                     options.dataset_folder,
                                     "Write the twin to this folder: pictures and gt.csv")
                          ->excludes(datasets)
                          ->excludes(sweep);
  leave->excludes(sweep)->excludes(make)->excludes(variants);
  app.add_option("--methods",
                 options.methods,
                 "Comma-separated; default: all methods that find the target themselves, with "
                 "--leave-one-out the default method and its detector")
      ->delimiter(',')
      ->excludes(sweep)
      ->excludes(make);
  for (CLI::Option* option :
       {app.add_option("--peer",
                       options.peers,
                       "NAME=COMMAND: a program that reads image paths and writes JSON lines")
            ->allow_extra_args(false),
        app.add_option("--report", options.report_folder, "Write an HTML report to this folder"),
        app.add_option("--frames",
                       options.frames_file,
                       "Write one JSON line per judged frame of the first method"),
        app.add_option("--finest-scale",
                       options.finest_scale,
                       "Search at this frame scale or coarser only, as the element does under load")
            ->capture_default_str()
            ->check(CLI::IsMember({1, 2, 4, 8})),
        app.add_flag("--all",
                     options.all_ellipses,
                     "Also evaluate all ellipses of each frame, not only the target"),
        app.add_option("--json", options.json_file, "Write all measures as JSON"),
        app.add_option(
               "--min-f1", options.limits.min_f1, "Exit with status 1 if a method's F1 is lower")
            ->check(finite_number() & CLI::Range(0.0, 1.0)),
        app.add_option("--min-recall",
                       options.limits.min_recall,
                       "Exit with status 1 if a method's recall is lower")
            ->check(finite_number() & CLI::Range(0.0, 1.0)),
        app.add_option("--max-false",
                       options.limits.max_false,
                       "Exit with status 1 if a method has more frames than this with a false "
                       "answer (FP or WD)")
            ->check(non_negative_integer())}) {
    option->excludes(sweep)->excludes(make)->excludes(leave);
  }
}

// Keeps freed memory. Otherwise glibc may return it to the system after each frame, and the page
// faults slow methods that allocate: the reference took up to 4.7 times as long.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest that glibc chooses by itself
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

}  // namespace
}  // namespace evaluate

int main(int argc, char** argv) {
  gst_init(nullptr, nullptr);
  cv::setNumThreads(1);
  evaluate::keep_freed_memory();
  evaluate::Options options;
  CLI::App app{"Measures the ellipse tracker and its peers on data sets with ground truth."};
  app.name("ellipse-evaluate");
  evaluate::add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  options.command = "ellipse-evaluate";
  for (int i = 1; i < argc; ++i) options.command += std::string(" ") + argv[i];
  std::signal(SIGINT, evaluate::on_interrupt);
  try {
    return evaluate::run(options);
  } catch (const std::exception& error) {
    std::cerr << "ellipse-evaluate: " << error.what() << '\n';
    return 1;
  }
}
