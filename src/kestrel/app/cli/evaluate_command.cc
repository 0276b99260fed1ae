// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/evaluation/evaluate_follow.h"
#include "kestrel/app/evaluation/evaluate_hunt.h"
#include "kestrel/app/evaluation/evaluate_landing.h"
#include "kestrel/app/evaluation/report.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/io/recording/tables/follow_csv.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
  std::string recording;
  std::string output;
  std::string report;  // empty: OUTPUT/evaluation
  bool force = false;
};

Report Evaluate(const EvaluateArguments& arguments) {
  const fs::path output(arguments.output);
  if (!fs::is_directory(output)) {
    throw InputError(arguments.output +
                     ": no folder, expected the output of `kestrel land`, `hunt` or `follow`");
  }
  if (fs::exists(output / "object_detections.csv")) {
    return EvaluateHunt(arguments.recording, arguments.output);
  }
  if (fs::exists(output / kFollowTable)) {
    return EvaluateFollow(arguments.recording, arguments.output);
  }
  return EvaluateLanding(arguments.recording, arguments.output);
}

void RunEvaluate(const EvaluateArguments& arguments) {
  const Report report = Evaluate(arguments);
  const fs::path folder = arguments.report.empty() ? fs::path(arguments.output) / "evaluation"
                                                   : fs::path(arguments.report);
  WriteReport(report, OutputFolder(folder, arguments.force));
  std::cout << ToMarkdown(report) << std::flush;
  fmt::print(stderr, "report: {}\n", (folder / "report.md").string());
}

}  // namespace

void AddEvaluateCommand(CLI::App* app) {
  CLI::App* command =
      app->add_subcommand("evaluate", "Compare an output folder with the recording's truth");
  const auto arguments = std::make_shared<EvaluateArguments>();
  command->add_option("RECORDING", arguments->recording, "A recording folder with ground truth")
      ->required();
  command
      ->add_option("OUTPUT", arguments->output,
                   "Folder that `kestrel land`, `hunt` or `follow` wrote for it by --output")
      ->required();
  command
      ->add_option("--report", arguments->report,
                   "Folder for the tables and plots (default: OUTPUT/evaluation)")
      ->type_name("DIR");
  command->add_flag("--force", arguments->force, "Replace files that exist");
  command->callback([arguments] { RunEvaluate(*arguments); });
}

}  // namespace kestrel
