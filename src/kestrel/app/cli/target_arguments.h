// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace kestrel {

// The options --target, --target-id and --target-size of several subcommands. Must live until the
// command line is parsed.
struct TargetArguments {
  std::string kind;  // empty: as configured
  std::optional<int> id;
  std::optional<double> size_m;

  // 'size_name': of the option for the size.
  void AddTo(CLI::App* command, const std::string& size_name = "--target-size");

  // Adds settings, as of --set, to those that are there. 'section': the key of the target. Throws
  // InputError where one of those sets the same.
  void AppendTo(std::vector<std::string>* settings, const std::string& section) const;

 private:
  std::string size_option_ = "--target-size";
};

}  // namespace kestrel
