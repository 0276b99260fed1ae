// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/option_arguments.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/core/base/options.h"

namespace kestrel {

void AddConfigCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand(
      "config", "Print every option with its value, unit and meaning, as YAML for --config");
  const auto arguments = std::make_shared<OptionArguments>();
  arguments->AddTo(command);
  command->callback([arguments] { std::cout << PrintOptions(arguments->Read()); });
}

}  // namespace kestrel
