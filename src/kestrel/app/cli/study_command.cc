// SPDX-License-Identifier: BSD-3-Clause
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// The modules are tried first, so that what is missing is reported in one line.
constexpr const char* kProgram = R"py(import sys
try:
    import distributed, fsspec, yaml
    from kestrel.study.__main__ import main
except ImportError as error:
    sys.exit("kestrel: kestrel study needs python3-kestrel and python3-distributed (%s: %s)"
             % (sys.executable, error))
sys.exit(main(sys.argv[1:])))py";

[[noreturn]] void BecomeStudy(const std::vector<std::string>& arguments) {
  // A study compares this command, unless its file names another.
  std::error_code ignored;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe", ignored).string();
  setenv("KESTREL_COMMAND", self.c_str(), /*overwrite=*/0);
  std::vector<const char*> words = {"python3", "-c", kProgram};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  words.push_back(nullptr);
  execvp(words[0], const_cast<char* const*>(words.data()));
  throw InputError(
      fmt::format("kestrel study needs python3-kestrel and python3-distributed ({}: {})", words[0],
                  std::strerror(errno)));
}

}  // namespace

void AddStudyCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand(
      "study", "Many recordings, several configurations or versions: run STUDY.yaml, report DIR");
  command->footer(
      "study run STUDY.yaml     do the units that have no result yet\n"
      "study report DIR         what the results show\n"
      "`kestrel study run --help` says more: a program of python3-kestrel");
  command->fallthrough(false);  // its arguments are those of the program
  command->prefix_command();
  command->callback([command] { BecomeStudy(command->remaining()); });
}

}  // namespace kestrel
