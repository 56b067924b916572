// SPDX-License-Identifier: MIT
#include "examples/evaluate/program.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>

#include "examples/evaluate/dataset.hpp"
#include "examples/evaluate/evaluation.hpp"
#include "examples/evaluate/evidence_fit.hpp"
#include "examples/evaluate/frame_files.hpp"
#include "examples/evaluate/leave_one_out.hpp"
#include "examples/evaluate/measures.hpp"
#include "examples/evaluate/method.hpp"
#include "examples/evaluate/picture_reader.hpp"
#include "examples/evaluate/progress.hpp"
#include "examples/evaluate/report.hpp"
#include "examples/evaluate/scenes.hpp"
#include "examples/evaluate/source_tables.hpp"
#include "examples/evaluate/sweep.hpp"
#include "examples/evaluate/tables.hpp"
#include "examples/evaluate/twin.hpp"
#include "examples/evaluate/variants.hpp"
#include "examples/evaluate/wild.hpp"

namespace evaluate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxProblemsPrinted = 20;
constexpr int kExitViolated = 1;
constexpr int kExitProblems = 2;
constexpr int kExitInterrupted = 130;

std::atomic<bool> interrupted = false;

// Returns false if the user has interrupted the run.
bool advance(ProgressBar& progress, const Frame& frame) {
  progress.advance(frame.name);
  return !interrupted;
}

std::ofstream open_for_writing(const std::string& file) {
  std::ofstream out(file);
  if (!out) throw std::runtime_error(file + ": cannot be written");
  out.precision(10);
  return out;
}

ellipse::TrackerSettings settings_from(const Options& options) {
  ellipse::TrackerSettings settings;
  for (const std::string& assignment : options.settings) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) {
      throw std::invalid_argument("--set " + assignment + ": expected property=value");
    }
    const std::string name = assignment.substr(0, equals);
    if (options.sweeps.empty() && (name == "detector" || name == "tracking")) {
      throw std::invalid_argument("--set " + assignment +
                                  ": --methods names detector and tracking");
    }
    ellipse::set_by_name(settings, name, assignment.substr(equals + 1));
  }
  settings.validate();
  return settings;
}

// One run of the program.
class Program {
 public:
  explicit Program(const Options& options)
      : options_(options),
        settings_(settings_from(options)),
        rule_(options.rule == "iou" ? Rule::kIou : Rule::kPublished) {}

  int run() {
    std::vector<Sweep> sweeps;
    for (const std::string& text : options_.sweeps) sweeps.push_back(parse_sweep(text));
    for (const std::string& text : options_.peers) peers_.push_back(parse_peer(text));
    std::vector<Property> grid;
    for (const std::string& text : options_.choices) grid.push_back(parse_property(text));
    if (options_.leave_one_out && grid.empty() && !options_.fit_evidence) {
      throw std::invalid_argument("--leave-one-out requires --choose or --fit-evidence");
    }
    gather();
    if (!options_.dataset_folder.empty()) {
      write_frame_files(options_.dataset_folder);
    } else if (options_.leave_one_out) {
      judge_left_out(grid);
    } else if (options_.fit_evidence) {
      fit_evidence();
    } else if (!sweeps.empty()) {
      for (const Sweep& sweep : sweeps) run_sweep(sweep);
    } else {
      compare();
    }
    print_problems();
    for (const std::string& text : violations_) std::cerr << "ellipse-evaluate: " << text << '\n';
    if (interrupted) return kExitInterrupted;
    if (!violations_.empty()) return kExitViolated;
    return missing_frames_ > 0 ? kExitProblems : 0;
  }

 private:
  void gather() {
    if (options_.datasets.empty()) {
      cv::Mat ground;
      if (!options_.ground_file.empty()) ground = PictureReader().read(options_.ground_file);
      sequences_ = make_twin(ground);
    }
    for (const std::string& argument : options_.datasets) {
      for (const fs::path& name : dataset_folders(argument)) gather(name.string());
    }
    const std::vector<Sequence> variants = variants_of(sequences_, options_.variants);
    sequences_.insert(sequences_.end(), variants.begin(), variants.end());
  }

  void gather(const std::string& name) {
    Dataset dataset = dataset_by_name(name);
    make_names_unique(dataset, name);
    missing_frames_ += dataset.missing_frames;
    problems_.insert(problems_.end(), dataset.problems.begin(), dataset.problems.end());
    for (Sequence& sequence : dataset.sequences) sequences_.push_back(std::move(sequence));
  }

  [[nodiscard]] Dataset dataset_by_name(const std::string& name) const {
    if (const auto seeds = scene_seeds(name)) return {make_scenes(*seeds, options_.pace), {}, 0};
    if (auto sequences = one_scene_by_name(name, options_.pace)) {
      return {std::move(*sequences), {}, 0};
    }
    if (const auto seeds = scene_seeds(name, "clutter")) {
      return {make_clutter(*seeds, options_.pace), {}, 0};
    }
    if (auto sequences = wild_by_name(name, options_.wild_seconds)) {
      return {std::move(*sequences), {}, 0};
    }
    if (const auto seeds = scene_seeds(name, "distorted")) {
      return {make_distorted(*seeds, options_.pace), {}, 0};
    }
    return read_dataset(name, options_.pictures_per_second);
  }

  // Results are reported by data set name, so equal names get a prefix.
  void make_names_unique(Dataset& dataset, const std::string& name) const {
    for (Sequence& sequence : dataset.sequences) {
      const bool is_taken =
          std::any_of(sequences_.begin(), sequences_.end(), [&](const auto& known) {
            return known.dataset == sequence.dataset;
          });
      if (is_taken) sequence.dataset = name + ":" + sequence.dataset;
    }
  }

  Evaluation evaluate_all(const std::vector<std::unique_ptr<Method>>& methods) {
    ProgressBar progress(frames_of(sequences_));
    Evaluation evaluation = evaluate(
        sequences_,
        methods,
        rule_,
        [&](const Frame& frame) { return advance(progress, frame); },
        options_.all_ellipses);
    note_missing(evaluation.problems);
    return evaluation;
  }

  // Counts each problem once, because every run over the frames reports it again.
  void note_missing(const std::vector<std::string>& problems) {
    for (const std::string& problem : problems) {
      if (std::ranges::find(problems_, problem) != problems_.end()) continue;
      problems_.push_back(problem);
      ++missing_frames_;
    }
  }

  std::vector<std::unique_ptr<Method>> make_methods() {
    std::vector<std::string> names = options_.methods;
    if (names.empty()) names = unaided_method_names();
    std::vector<std::unique_ptr<Method>> methods;
    for (const std::string& name : names) {
      methods.push_back(make_method(name, settings_, options_.finest_scale));
    }
    if (!peers_.empty()) {
      files_.emplace();
      write_frame_files(files_->path());
    }
    for (const PeerCommand& peer : peers_) {
      try {
        methods.push_back(
            make_command_method(peer, sequences_, problems_, [] { return !interrupted; }));
      } catch (const std::runtime_error& error) {
        if (!interrupted) throw;
        problems_.emplace_back(error.what());
      }
    }
    return methods;
  }

  // Writes files for other programs or for --frames.
  void write_frame_files(const fs::path& folder) {
    ProgressBar progress(frames_without_files(sequences_));
    write_files(sequences_, folder, [&](const Frame& frame) { return advance(progress, frame); });
    if (interrupted) {
      throw std::runtime_error("interrupted while writing frames to " + folder.string());
    }
  }

  void judge_left_out(const std::vector<Property>& grid) {
    const SourceGroups groups =
        options_.groups_file.empty() ? SourceGroups() : SourceGroups(options_.groups_file);
    std::vector<std::string> methods = options_.methods;
    if (methods.empty()) methods = default_method_names();
    for (const std::string& method : methods) judge_left_out(grid, groups, method);
  }

  void judge_left_out(const std::vector<Property>& grid,
                      const SourceGroups& groups,
                      const std::string& method) {
    if (interrupted) return;
    const ellipse::TrackerSettings settings = settings_of(method, settings_);
    ProgressBar progress(2 * frames_of(sequences_));  // choosing, then judging
    const auto next = [&](const Frame& frame) { return advance(progress, frame); };
    const auto judge = [&](auto& chooser) {
      note_missing(chooser.problems());
      const auto results = interrupted
                               ? std::vector<LeftOut>()
                               : leave_one_out(sequences_, groups, chooser, settings, rule_, next);
      if (results.empty()) return;
      print(std::cout, left_out_table(method, results));
      print(std::cout, in_sample_table(method, results));
    };
    if (!options_.fit_evidence) {
      GridChooser chooser(grid, settings, sequences_, rule_, next);
      judge(chooser);
      return;
    }
    EvidenceFitter fitter(settings, sequences_, next);
    judge(fitter);
    if (!interrupted) print(std::cout, calibration_table(fitter.left_out_calibration(groups)));
  }

  void fit_evidence() {
    std::ofstream out;
    if (!options_.evidence_file.empty()) out = open_for_writing(options_.evidence_file);
    ProgressBar progress(frames_of(sequences_));
    const EvidenceFitter fitter(
        settings_, sequences_, [&](const Frame& frame) { return advance(progress, frame); });
    note_missing(fitter.problems());
    if (interrupted) return;
    ellipse::write_evidence(out.is_open() ? out : std::cout, fitter.fit_all());
    check_written(out, options_.evidence_file);
  }

  void compare() {
    std::ofstream frames_out;
    if (!options_.frames_file.empty()) frames_out = open_for_writing(options_.frames_file);
    std::ofstream json_out;
    if (!options_.json_file.empty()) json_out = open_for_writing(options_.json_file);
    const std::vector<std::unique_ptr<Method>> methods = make_methods();
    const Evaluation evaluation = evaluate_all(methods);
    print_interruption(evaluation);
    for (const std::string& dataset : datasets_of(evaluation)) {
      for (const Table& table : all_tables(evaluation, dataset)) print(std::cout, table);
    }
    for (const Table& table : source_tables(evaluation)) print(std::cout, table);
    violations_ = violated_limits(evaluation, options_.limits);
    if (frames_out.is_open()) write_frames(frames_out, evaluation, 0);
    if (json_out.is_open()) write_json(json_out, evaluation);
    check_written(frames_out, options_.frames_file);
    check_written(json_out, options_.json_file);
    if (!options_.report_folder.empty()) {
      write_report(evaluation, options_.command, problems_, options_.report_folder);
    }
  }

  void run_sweep(const Sweep& sweep) {
    if (interrupted) return;
    const std::vector<std::unique_ptr<Method>> methods = methods_of(sweep, settings_);
    const Evaluation evaluation = evaluate_all(methods);
    print_interruption(evaluation);
    print(std::cout, sweep_table(sweep, evaluation));
    write_sweep(sweep, evaluation, options_.sweep_folder);
  }

  static void print_interruption(const Evaluation& evaluation) {
    if (!evaluation.is_interrupted) return;
    std::cout << "Interrupted: the results cover " << evaluation.frames.size() << " of "
              << evaluation.planned_frames << " frames.\n";
  }

  static void check_written(std::ofstream& out, const std::string& file) {
    if (out.is_open() && !out.flush()) throw std::runtime_error(file + ": cannot be written");
  }

  void print_problems() const {
    if (missing_frames_ > 0) {
      std::cout << "\nMissing frames: " << missing_frames_ << ". No result includes them.\n";
    }
    for (std::size_t i = 0; i < std::min(problems_.size(), kMaxProblemsPrinted); ++i) {
      std::cerr << "ellipse-evaluate: " << problems_[i] << '\n';
    }
    if (problems_.size() > kMaxProblemsPrinted) {
      std::cerr << "ellipse-evaluate: and " << problems_.size() - kMaxProblemsPrinted << " more\n";
    }
  }

  const Options& options_;
  ellipse::TrackerSettings settings_;
  Rule rule_;
  std::vector<PeerCommand> peers_;
  std::vector<Sequence> sequences_;
  std::vector<std::string> problems_;
  std::vector<std::string> violations_;
  std::size_t missing_frames_ = 0;
  std::optional<TemporaryFolder> files_;  // for other programs
};

}  // namespace

int run(const Options& options) {
  const int status = Program(options).run();
  if (!std::cout.flush()) throw std::runtime_error("standard output: cannot be written");
  return status;
}

void interrupt() {
  interrupted = true;
}

}  // namespace evaluate
