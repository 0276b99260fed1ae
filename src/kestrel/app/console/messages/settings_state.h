// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

// An option that a pilot changes in the field, with its name in `kestrel config`.
struct ConsoleSetting {
  std::string name;
  std::string label;
  std::string value;  // that the next start would use
  std::string unit;
  std::string meaning;
  std::vector<std::string> choices = {};  // empty: any value of its kind
  bool is_given = false;                  // on the command line, whose value holds over the file's
};

// The settings of a flight, which the page changes in its configuration file.
struct ConsoleSettings {
  std::string file;  // empty: none was given, so nothing can be saved
  std::vector<ConsoleSetting> settings;
  std::string saved = {};  // what was done with the last change; empty: nothing yet
  std::string error = {};  // why it was refused
};

}  // namespace kestrel
