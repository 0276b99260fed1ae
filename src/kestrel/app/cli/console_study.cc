// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/console_study.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/page_links.h"
#include "kestrel/app/console/study/study_console.h"
#include "kestrel/app/console/study/study_results.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"

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

// The options of the study's run, changed by --set and --target of `kestrel console`.
KestrelOptions OptionsFor(const ConsoleArguments& given, const OptionArguments& of_study,
                          const StudyVariant& variant, const std::string& text) {
  KestrelOptions options;
  ReadOptionFields(text, fmt::format("options of '{}' in the study", variant.configuration),
                   FieldsOf(options));
  std::vector<std::string> settings;
  of_study.target.AppendTo(&settings, "landing.target");
  const std::vector<std::string> own = given.source.options.Settings();
  settings.insert(settings.end(), own.begin(), own.end());
  for (const std::string& setting : settings) SetOption(setting, &options);
  RequireValid(options);
  return options;
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

StudyConsole::Run OpenForReplay(const ConsoleArguments& given, const std::string& path,
                                const StudyVariant& variant, const StudyOptions& of_run) {
  if (!HasSearch(variant.task)) {
    throw InputError(
        fmt::format("a study of '{}' cannot be replayed, only of land and hunt", variant.task));
  }
  RequireHere(path);
  ConsoleArguments arguments = given;
  arguments.source.options = {};
  ReadWords(of_run.arguments, &arguments);
  arguments.source.sources = {path};
  arguments.task.name = variant.task;
  arguments.RequireEnd();
  StudyConsole::Run run;
  run.search =
      MakeSearch(arguments, OptionsFor(given, arguments.source.options, variant, of_run.text));
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
  StudyResults results(folder);
  std::vector<StudyVariant> variants = results.Variants();
  ConsoleArguments any = arguments;
  if (HasSearch(variants.front().task)) any.task.name = variants.front().task;
  ReplaySubject subject = MakeSearch(any, options)->Subject();
  subject.has_truth = true;  // some recordings may have it
  StudyConsole console(arguments.PageOptions(options), folder, std::move(results), variants,
                       std::move(subject),
                       [&](const std::string& path, const auto& variant, const auto& of_run) {
                         return OpenForReplay(arguments, path, variant, of_run);
                       });
  PrintLinks(console.urls());
  console.Play(WasInterrupted);
}

}  // namespace kestrel
