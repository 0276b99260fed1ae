// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/task.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/flight/session/follow_task.h"
#include "kestrel/flight/session/hunt_task.h"
#include "kestrel/flight/session/land_task.h"

namespace kestrel {
namespace {

std::unique_ptr<Task> MakeLand(const TaskOptions& options, const TaskChoice& choice) {
  return std::make_unique<LandTask>(options.landing, choice.predict_s);
}

std::unique_ptr<Task> MakeHunt(const TaskOptions& options, const TaskChoice& choice) {
  return std::make_unique<HuntTask>(options.hunt, choice.model, choice.grid, choice.origin,
                                    choice.go);
}

std::unique_ptr<Task> MakeFollow(const TaskOptions& options, const TaskChoice& choice) {
  return std::make_unique<FollowTask>(options.follow, choice.mark);
}

constexpr TaskKind kKinds[] = {
    {"land", "Run the landing pipeline over a source", "Land on the pattern", MakeLand},
    {"hunt", "Run the coloured-object pipeline over a source",
     "Search for coloured objects instead of the landing pattern", MakeHunt},
    {"follow", "Follow what is marked in an image of a source",
     "Follow what is marked instead of the landing pattern", MakeFollow},
};

}  // namespace

std::span<const TaskKind> TaskKinds() { return kKinds; }

std::unique_ptr<Task> MakeTask(std::string_view name, const TaskOptions& options,
                               const TaskChoice& choice) {
  const auto kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                 [&](const TaskKind& one) { return one.name == name; });
  if (kind == std::end(kKinds)) {
    std::vector<std::string_view> names;
    for (const TaskKind& one : kKinds) names.push_back(one.name);
    throw InputError(fmt::format("no task '{}', expected {}", name, fmt::join(names, " or ")));
  }
  return kind->make(options, choice);
}

}  // namespace kestrel
