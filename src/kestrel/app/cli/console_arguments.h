// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/cli/task_argument.h"
#include "kestrel/app/console/replay/replay_search.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/app/web_server/console_options.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The arguments of `kestrel console`.
struct ConsoleArguments {
  SourceArguments source;
  std::string address;
  std::string model;
  std::string output;  // folder for the files that the page saves; empty: OutputFolder
  TaskArgument task;
  bool is_demo = false;
  // Result of `kestrel land` or `hunt` that is shown instead of a new run; empty: none.
  std::string result;

  // Returns the options of the page. Throws InputError when the address is not valid.
  ConsoleOptions PageOptions(const KestrelOptions& options) const;
  LandingPipelineOptions LandingOptions(const KestrelOptions& options) const;

  // The folder for what the page saves of a recording.
  std::string OutputFolder() const { return output.empty() ? "taught" : output; }
  // True when the source is one camera.
  bool IsLive() const;
  // Throws InputError when a source is a camera.
  void RequireEnd() const;
};

// True for a task whose results a page over a recording can show.
bool HasSearch(std::string_view task);

// Returns the search of the recording, with the options of `kestrel land` or `kestrel hunt`. There
// must be one for the task. Throws InputError when the model cannot be read.
std::unique_ptr<ReplaySearch> MakeSearch(const ConsoleArguments& arguments,
                                         const KestrelOptions& options);

}  // namespace kestrel
