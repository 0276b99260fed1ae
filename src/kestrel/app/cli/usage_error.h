// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace kestrel {

// Reports in one line what is wrong with a command line, with the command's name. 'words': the
// command line without the program.
std::string UsageErrorInWords(const CLI::App& app, const CLI::ParseError& error,
                              const std::vector<std::string>& words);

}  // namespace kestrel
