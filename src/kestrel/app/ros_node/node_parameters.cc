// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/ros_node/node_parameters.h"

#include <fmt/format.h>

#include "kestrel/app/options/kestrel_options.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

// All that a file or a parameter may name. Where both have an option, the first one takes it: the
// node's.
struct NamedOptions {
  NodeOptions node;
  KestrelOptions commands;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    NodeOptions::Visit(self.node, visitor);
    KestrelOptions::Visit(self.commands, visitor);
  }
};

}  // namespace

NodeOptions ReadNodeOptions(const NodeParameters& parameters) {
  NamedOptions options;
  for (const auto& [key, value] : parameters) {
    if (key == "config" && !value.empty()) ReadOptions(value, &options);
  }
  for (const auto& [key, value] : parameters) {
    SetOption(fmt::format("{}={}", key, value), &options);
  }
  RequireValid(options.node);
  return options.node;
}

}  // namespace kestrel
