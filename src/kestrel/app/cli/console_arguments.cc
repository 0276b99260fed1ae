// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/console_arguments.h"

#include <algorithm>
#include <iterator>

#include "kestrel/app/cli/console_camera.h"
#include "kestrel/app/console/replay/hunt_replay.h"
#include "kestrel/app/console/replay/landing_replay.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

std::unique_ptr<ReplaySearch> MakePatternSearch(const ConsoleArguments& arguments,
                                                const KestrelOptions& options) {
  const SourceArguments& source = arguments.source;
  return SearchForPattern(source.sources, arguments.LandingOptions(options), source.altitude_m);
}

std::unique_ptr<ReplaySearch> MakeObjectSearch(const ConsoleArguments& arguments,
                                               const KestrelOptions& options) {
  const SourceArguments& source = arguments.source;
  HuntPipelineOptions hunt = options.hunt;
  hunt.still = hunt.still || source.still;
  return SearchForObjects(source.sources, hunt, ReadModel(arguments.model), source.altitude_m);
}

// The tasks that a page can show.
struct Search {
  std::string_view task;
  std::unique_ptr<ReplaySearch> (*make)(const ConsoleArguments& arguments,
                                        const KestrelOptions& options);
};
constexpr Search kSearches[] = {{"land", MakePatternSearch}, {"hunt", MakeObjectSearch}};

const Search* FindSearch(std::string_view task) {
  return std::find_if(std::begin(kSearches), std::end(kSearches),
                      [&](const Search& search) { return search.task == task; });
}

}  // namespace

ConsoleOptions ConsoleArguments::PageOptions(const KestrelOptions& options) const {
  if (address.empty()) return options.console;
  return Checked(WithAddress(options.console, address, "--address"));
}

LandingPipelineOptions ConsoleArguments::LandingOptions(const KestrelOptions& options) const {
  LandingPipelineOptions landing = options.landing;
  landing.still = landing.still || source.still;
  return landing;
}

bool ConsoleArguments::IsLive() const {
  return source.sources.size() == 1 && task.name == "land" && IsLiveSource(source.sources.front());
}

void ConsoleArguments::RequireEnd() const {
  for (const std::string& name : source.sources) {
    if (!IsLiveSource(name)) continue;
    throw InputError(name +
                     ": the page needs any frame at any time, expected a recording, a bag, images "
                     "or a video; `kestrel fly --console` shows a camera");
  }
}

bool HasSearch(std::string_view task) { return FindSearch(task) != std::end(kSearches); }

std::unique_ptr<ReplaySearch> MakeSearch(const ConsoleArguments& arguments,
                                         const KestrelOptions& options) {
  return FindSearch(arguments.task.name)->make(arguments, options);
}

}  // namespace kestrel
