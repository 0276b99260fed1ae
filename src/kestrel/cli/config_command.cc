// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/config_command.h"

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "kestrel/base/options.h"
#include "kestrel/cli/kestrel_options.h"
#include "kestrel/cli/option_arguments.h"

namespace kestrel {

void AddConfigCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand(
      "config", "Print every option with its value, unit and meaning, as YAML for --config");
  const auto arguments = std::make_shared<OptionArguments>();
  arguments->AddTo(command);
  command->callback([arguments] { std::cout << PrintOptions(arguments->Read()); });
}

}  // namespace kestrel
