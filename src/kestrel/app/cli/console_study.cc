// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/console_study.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/console/study_console.h"
#include "kestrel/app/console/study_plan.h"
#include "kestrel/app/console/study_results.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// Reads the arguments that the study gave to `kestrel land` or `hunt`, as far as they say how the
// recording is read and searched.
void ReadWords(const std::vector<std::string>& words, ConsoleArguments* arguments) {
  CLI::App app;
  app.allow_extras();
  arguments->source.AddReadingTo(&app);
  app.get_option("SOURCE")->required(false);
  arguments->source.options.target.AddTo(&app);
  app.add_option("--model", arguments->model);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("the study's arguments: {}", error.what()));
  }
}

// The arguments of `kestrel console` that replay a recording with a variant's options.
ConsoleArguments ArgumentsFor(const ConsoleArguments& given, const StudyPlan& plan,
                              const std::string& path, const StudyVariant& variant) {
  ConsoleArguments arguments = given;
  std::vector<std::string>& settings = arguments.source.options.settings;
  settings.clear();
  ReadWords(plan.ArgumentsOf(variant.configuration), &arguments);
  const std::vector<std::string>& last = given.source.options.settings;
  std::copy(last.begin(), last.end(), std::back_inserter(settings));
  arguments.source.sources = {path};
  arguments.is_hunt = variant.task == "hunt";
  return arguments;
}

// Throws InputError when a recording of a study is not a file or folder of this computer.
void RequireHere(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) return;
  if (path.starts_with("kestrel simulate ")) {  // the study has the command in the path's place
    throw InputError("the study simulated it and did not keep it; " + path + " makes it again");
  }
  throw InputError("the recording is not on this computer: " + path);
}

StudyConsole::Run OpenForReplay(const ConsoleArguments& arguments, const StudyVariant& variant) {
  const std::string& path = arguments.source.sources.front();
  if (variant.task != "land" && variant.task != "hunt") {
    throw InputError(
        fmt::format("a study of '{}' cannot be replayed, only of land and hunt", variant.task));
  }
  RequireHere(path);
  arguments.RequireEnd();
  StudyConsole::Run run;
  run.search = MakeSearch(arguments, arguments.source.options.Read());
  run.choice = arguments.source.Recording(run.search->format());
  return run;
}

}  // namespace

bool IsStudy(const ConsoleArguments& arguments) {
  const std::vector<std::string>& sources = arguments.source.sources;
  return sources.size() == 1 && StudyResults::IsIn(sources.front());
}

void RunStudyConsole(const ConsoleArguments& arguments) {
  CatchInterrupts();
  const KestrelOptions options = arguments.source.options.Read();
  const std::string& folder = arguments.source.sources.front();
  const StudyPlan plan(folder);
  StudyResults results(folder);
  std::vector<StudyVariant> variants = results.Variants();
  std::stable_sort(variants.begin(), variants.end(), [&](const auto& a, const auto& b) {
    return plan.PlaceOf(a.configuration) < plan.PlaceOf(b.configuration);
  });
  ConsoleArguments any = arguments;
  any.is_hunt = variants.front().task == "hunt";
  ReplaySubject subject = MakeSearch(any, options)->Subject();
  subject.has_truth = true;  // some recordings may have it
  StudyConsole console(arguments.PageOptions(options), folder, std::move(results), variants,
                       std::move(subject), [&](const std::string& path, const auto& variant) {
                         return OpenForReplay(ArgumentsFor(arguments, plan, path, variant),
                                              variant);
                       });
  fmt::print(stderr, "console: {}\n", console.url());
  console.Play(WasInterrupted);
}

}  // namespace kestrel
