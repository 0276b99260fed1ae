// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/options/fly_options.h"
#include "kestrel/app/web_server/console_options.h"
#include "kestrel/comms/team/team_link.h"
#include "kestrel/flight/ros/dds_options.h"
#include "kestrel/flight/session/task.h"

namespace kestrel {

// The options of all subcommands, as `kestrel config` prints and --config reads them.
struct KestrelOptions : TaskOptions {
  FlyOptions fly;
  ConsoleOptions console;
  TeamLinkOptions team;
  DdsOptions dds;

  static void Visit(auto& self, auto&& visit) {
    TaskOptions::Visit(self, visit);
    visit.Group("fly", self.fly);
    visit.Group("console", self.console);
    visit.Group("team", self.team);
    visit.Group("dds", self.dds);
  }
};

// Returns the defaults, changed first by the file (if not empty) and then by the settings
// "key=value". Throws InputError when one of them or the result is not valid.
KestrelOptions ReadKestrelOptions(const std::string& config_file,
                                  const std::vector<std::string>& settings);

}  // namespace kestrel
