// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "enum_casters.h"

namespace kestrel::python {

// Adds a subclass of str and enum.Enum to the module: a member is equal to its word and prints as
// it. Returns the class.
pybind11::object AddEnum(pybind11::module_& module, const char* name,
                         const std::vector<std::string>& words, const char* doc);

template <class Enum>
void BindEnum(pybind11::module_& module, const char* doc) {
  std::vector<std::string> words;
  for (const Enum value : Words<Enum>::kValues) words.emplace_back(Words<Enum>::Of(value));
  EnumClass<Enum>() = AddEnum(module, Words<Enum>::kName, words, doc);
}

}  // namespace kestrel::python
