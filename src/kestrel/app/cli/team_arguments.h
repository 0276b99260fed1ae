// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace kestrel {

// The option --team. Must live until the command line is parsed.
struct TeamArguments {
  std::string team;  // empty: none

  // Adds the option.
  CLI::Option* AddTo(CLI::App* command) {
    return command
        ->add_option("--team", team,
                     "Team that shares one map, which is written to team_map.csv; in the DDS "
                     "domain of --dds (else ROS_DOMAIN_ID, else 0)")
        ->type_name("NAME");
  }
};

}  // namespace kestrel
