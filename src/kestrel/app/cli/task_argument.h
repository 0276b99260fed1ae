// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "kestrel/flight/session/task.h"

namespace kestrel {

// The task of a subcommand that runs any of them: the first of all kinds, or that of a flag, as
// --hunt. Must live until the command line is parsed.
struct TaskArgument {
  std::string name{TaskKinds().front().name};

  // Adds the flags of all tasks but those that 'is_offered' leaves out.
  void AddTo(CLI::App* command, bool (*is_offered)(std::string_view task)) {
    std::vector<CLI::Option*> flags;
    for (const TaskKind& kind : TaskKinds().subspan(1)) {
      if (!is_offered(kind.name)) continue;
      CLI::Option* const flag =
          command->add_flag(fmt::format("--{0}{{{0}}}", kind.name), name, kind.instead);
      for (CLI::Option* const other : flags) flag->excludes(other);
      flags.push_back(flag);
    }
  }
};

}  // namespace kestrel
