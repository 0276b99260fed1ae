// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "casters.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/options.h"

namespace kestrel::python {

// Returns the path that 'options' are, if they are one and no dict.
std::optional<std::string> PathOf(const pybind11::object& options);

// Reads the file of a command's configuration. Other groups are for others. Throws InputError as
// ReadOptions does.
TaskOptions ReadConfiguration(const std::string& path);

// Sets the fields that a dict names: the names of the YAML file, in dicts of groups or with dots
// ("pattern.outer_diameter_m"). Throws InputError for an unknown name, which it compares with the
// known ones, and for a value of another type.
void SetFields(const pybind11::dict& values, const OptionFields& fields);

// Returns the names and values of a dict as "key=value".
std::vector<std::string> Settings(const pybind11::dict& values);

// Issues Python's warnings of what is allowed but not advisable. The options must be valid.
void WarnOf(const TargetOptions& target);

// Returns the options of a class: those of 'options' (nothing, a dict, or the path of a
// configuration file, of which 'part' takes its part), changed by the keyword arguments.
template <class Options, class Part>
Options OptionsOf(const pybind11::object& options, const pybind11::kwargs& keywords, Part part) {
  Options result = part(TaskOptions());
  if (const auto path = PathOf(options)) {
    result = part(ReadConfiguration(*path));
  } else if (!options.is_none()) {
    SetFields(options.cast<pybind11::dict>(), FieldsOf(result));
  }
  SetFields(keywords, FieldsOf(result));
  return result;
}

}  // namespace kestrel::python
