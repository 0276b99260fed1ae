// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <iostream>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/option_arguments.h"
#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

bool HaveSameValue(const OptionField& a, const OptionField& b) {
  return std::visit(
      [](const auto* x, const auto* y) {
        if constexpr (std::is_same_v<decltype(x), decltype(y)>) return *x == *y;
        return false;
      },
      a.value, b.value);
}

// Prints the options of a user with those of the simulators that are set, or all of the
// simulators'.
void PrintOptions(KestrelOptions options, bool simulation) {
  KestrelOptions unset;
  const OptionFields fields = FieldsOf(options);
  const OptionFields defaults = FieldsOf(unset);
  OptionFields printed;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const bool is_simulators = fields[i].key.starts_with("fly.sim_");
    const bool is_set = !HaveSameValue(fields[i], defaults[i]);
    if (simulation ? is_simulators : !is_simulators || is_set) printed.push_back(fields[i]);
  }
  std::cout << PrintOptionFields(printed);
}

}  // namespace

void AddConfigCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand(
      "config", "Print every option with its value, unit and meaning, as YAML for --config");
  const auto arguments = std::make_shared<OptionArguments>();
  const auto simulation = std::make_shared<bool>(false);
  arguments->AddTo(command);
  command->add_flag("--simulation", *simulation, "Print all of the simulated camera and autopilot");
  command->callback([arguments, simulation] { PrintOptions(arguments->Read(), *simulation); });
}

}  // namespace kestrel
