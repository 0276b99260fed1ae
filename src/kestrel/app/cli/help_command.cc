// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <memory>
#include <string>

#include "kestrel/app/cli/commands.h"

namespace kestrel {
namespace {

const CLI::App& Described(const CLI::App& app, const std::string& name) {
  if (name.empty()) return app;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == name) return *command;
  }
  throw CLI::ValidationError("help", "there is no subcommand '" + name + "'");
}

}  // namespace

void AddHelpCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("help", "Print this help, or that of a subcommand");
  const auto name = std::make_shared<std::string>();
  command->add_option("SUBCOMMAND", *name, "The subcommand to describe");
  command->callback([app, name] {
    const CLI::App& described = Described(*app, *name);
    const std::string title = name->empty() ? "kestrel" : "kestrel " + *name;
    std::cout << app->get_formatter()->make_help(&described, title, CLI::AppFormatMode::Normal);
  });
}

}  // namespace kestrel
