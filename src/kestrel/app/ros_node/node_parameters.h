// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kestrel/flight/ros/node_options.h"

namespace kestrel {

// Pairs of key ("landing.detector.min_quality") and value.
using NodeParameters = std::vector<std::pair<std::string, std::string>>;

// Returns the defaults, changed by the file that `config` names and then by the parameters. Options
// of `kestrel config` that only the commands use are checked and have no effect. Throws InputError
// when one of them does not exist or is not valid.
NodeOptions ReadNodeOptions(const NodeParameters& parameters);

}  // namespace kestrel
