// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "kestrel/app/cli/target_arguments.h"
#include "kestrel/app/options/kestrel_options.h"

namespace kestrel {

// The options --config and --set of several subcommands, and the target of those that have one.
// Must live until the command line is parsed.
struct OptionArguments {
  std::string config;
  std::vector<std::string> settings;
  TargetArguments target;  // its AddTo is for the subcommand to call

  void AddTo(CLI::App* command) {
    command->add_option("--config", config, "Options from a YAML file (see `kestrel config`)")
        ->type_name("FILE");
    command->add_option("--set", settings, "One option, as key=value; can be given several times")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
  }
  // Returns what these arguments set over the file, as "key=value".
  std::vector<std::string> Settings() const {
    std::vector<std::string> all = settings;
    target.AppendTo(&all, "landing.target");
    return all;
  }
  // Returns the options, after saying what of them is not advisable.
  KestrelOptions Read() const {
    KestrelOptions options = ReadKestrelOptions(config, Settings());
    for (const std::string& warning : options.landing.target.Warnings()) {
      fmt::print(stderr, "kestrel: warning: {}\n", warning);
    }
    return options;
  }
};

}  // namespace kestrel
