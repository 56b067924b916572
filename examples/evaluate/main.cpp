// SPDX-License-Identifier: MIT
//
// ellipse-evaluate: measures the tracker and its peers on data sets with ground truth, and prints
// the tables and figures of [Keipour2021] III.
#include <gst/gst.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <iostream>
#include <opencv2/core.hpp>

#include "examples/evaluate/program.hpp"
#include "examples/finite_number.hpp"

namespace evaluate {
namespace {

void on_interrupt(int /*signal*/) {
  interrupt();
  std::signal(SIGINT, SIG_DFL);  // the second time in earnest
}

CLI::Option* add_leave_one_out(CLI::App& app, Options& options, CLI::Option* datasets) {
  CLI::Option* choose = app.add_option("--choose",
                                       options.choices,
                                       "PROPERTY=VALUE:VALUE... or PROPERTY=FROM:TO:STEP; several "
                                       "make a grid")
                            ->allow_extra_args(false);
  CLI::Option* leave = app.add_flag("--leave-one-out",
                                    options.leave_one_out,
                                    "For each data set: choose on the others, report on this one")
                           ->needs(datasets);
  choose->needs(leave);
  CLI::Option* fit =
      app.add_flag("--fit-evidence",
                   options.fit_evidence,
                   "Fit the table by which the detector arcs decides to the data sets; with "
                   "--leave-one-out to all but the one that is judged")
          ->needs(datasets)
          ->excludes(choose);
  app.add_option("--out", options.evidence_file, "Write the table there; none = to the terminal")
      ->needs(fit)
      ->excludes(leave);
  app.add_option("--groups",
                 options.groups_file,
                 "Which data sets are left out together: lines GROUP: NAME NAME..., with * and ?; "
                 "none = airlab-*; all rendered ones")
      ->needs(leave);
  return leave;
}

void add_options(CLI::App& app, Options& options) {
  CLI::Option* datasets = app.add_option(
      "DATASET",
      options.datasets,
      "Folders with gt.csv or ground_truth.txt, or folders of such; scenes:SEED, scenes:FROM-TO or "
      "a list of them = all scenes of the catalog; distorted:SEED and so on = the same "
      "through lenses that distort the picture; wild:SEED and so on = random scenes; "
      "wild-frames:SEED and so on = a frame of each; clutter:SEED and so on = what resembles a pad "
      "and is none; none = the rendered twin");
  app.add_option(
         "--seconds", options.pace.seconds, "How long each of scenes:SEED and distorted:SEED is")
      ->capture_default_str()
      ->check(finite_number() & CLI::PositiveNumber)
      ->needs(datasets);
  app.add_option("--wild-seconds", options.wild_seconds, "How long each of wild:SEED is")
      ->capture_default_str()
      ->check(finite_number() & CLI::PositiveNumber)
      ->needs(datasets);
  app.add_option("--fps",
                 options.pace.frames_per_second,
                 "Frames a second of scenes:SEED, distorted:SEED, and pictures without a time")
      ->capture_default_str()
      ->check(finite_number() & CLI::PositiveNumber)
      ->needs(datasets);
  app.add_option("--set", options.settings, "property=value, as of the element ellipsetrack")
      ->allow_extra_args(false);
  app.add_option("--rule", options.rule, "When an answer is right")
      ->capture_default_str()
      ->check(CLI::IsMember({"iou", "published"}));
  CLI::Option* sweep =
      app.add_option("--sweep",
                     options.sweeps,
                     "PROPERTY=FROM:TO:STEP or PROPERTY=VALUE,...: how much depends on it")
          ->allow_extra_args(false);
  app.add_option("--sweep-dir", options.sweep_folder, "Where sweeps leave CSV, SVG and PNG")
      ->capture_default_str()
      ->needs(sweep);
  app.add_option("--ground", options.ground_file, "A picture to lie under the twin's scenes")
      ->excludes(datasets);
  CLI::Option* leave = add_leave_one_out(app, options, datasets);
  CLI::Option* make =
      app.add_option(
             "--make-dataset", options.dataset_folder, "Write the twin: pictures and gt.csv")
          ->excludes(datasets)
          ->excludes(sweep);
  leave->excludes(sweep)->excludes(make);
  app.add_option("--methods",
                 options.methods,
                 "Separated by commas; none = all but those that are told the target, with "
                 "--leave-one-out the default and its detector")
      ->delimiter(',')
      ->excludes(sweep)
      ->excludes(make);
  for (CLI::Option* option :
       {app.add_option("--peer",
                       options.peers,
                       "NAME=COMMAND: a program that reads image paths and answers JSON lines")
            ->allow_extra_args(false),
        app.add_option("--report", options.report_folder, "Write a page with everything in it"),
        app.add_option("--frames",
                       options.frames_file,
                       "Write one JSON line for each frame that is judged, of the first method"),
        app.add_flag("--all",
                     options.all_ellipses,
                     "Also compare all ellipses of each frame, not the target alone"),
        app.add_option("--json", options.json_file, "Write all measures as JSON"),
        app.add_option(
               "--min-f1", options.limits.min_f1, "Exit with 1 where a method's F1 is lower")
            ->check(finite_number() & CLI::Range(0.0, 1.0)),
        app.add_option(
               "--min-recall", options.limits.min_recall, "Exit with 1 where its recall is lower")
            ->check(finite_number() & CLI::Range(0.0, 1.0)),
        app.add_option("--max-false",
                       options.limits.max_false,
                       "Exit with 1 where more of its frames have a false answer (FP or WD)")
            ->check(CLI::NonNegativeNumber)}) {
    option->excludes(sweep)->excludes(make)->excludes(leave);
  }
}

}  // namespace
}  // namespace evaluate

int main(int argc, char** argv) {
  gst_init(nullptr, nullptr);
  cv::setNumThreads(1);
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
