// SPDX-License-Identifier: BSD-3-Clause
#include "option_values.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <variant>

#include <fmt/format.h>

#include "bindings.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/error.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// Groups of a configuration file that no class here reads.
const std::set<std::string> kOtherGroups = {"fly", "console", "team", "dds"};

std::string TypeNameOf(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__")).cast<std::string>();
}

// Assigns a value of Python to a field of an options struct.
struct Assigner {
  const std::string& key;
  const py::handle& value;

  void operator()(bool* field) const {
    if (!py::isinstance<py::bool_>(value)) throw Refused("True or False");
    *field = value.cast<bool>();
  }
  void operator()(int* field) const {
    if (!PyIndex_Check(value.ptr()) || py::isinstance<py::bool_>(value)) {
      throw Refused("a whole number");
    }
    *field = Cast<int>("a whole number");
  }
  void operator()(double* field) const {
    if (!PyNumber_Check(value.ptr()) || py::isinstance<py::bool_>(value)) {
      throw Refused("a finite number");
    }
    *field = Cast<double>("a finite number");
    if (!std::isfinite(*field)) throw Refused("a finite number");
  }
  void operator()(std::string* field) const {
    if (const auto path = PathOf(py::reinterpret_borrow<py::object>(value))) {
      *field = *path;
    } else {
      throw Refused("a text");
    }
  }

 private:
  template <class Number>
  Number Cast(const char* expected) const {
    try {
      return value.cast<Number>();
    } catch (const py::cast_error&) {
      throw Refused(expected);
    }
  }
  InputError Refused(const char* expected) const {
    return InputError(fmt::format("{}: got {} ({}), expected {}", key,
                                  py::repr(value).cast<std::string>(), TypeNameOf(value),
                                  expected));
  }
};

bool IsGroup(const std::string& key, const OptionFields& fields) {
  return std::any_of(fields.begin(), fields.end(),
                     [&](const OptionField& field) { return field.key.starts_with(key + "."); });
}

void SetGroup(const std::string& prefix, const py::dict& values, const OptionFields& fields) {
  for (const auto& [name, value] : values) {
    const std::string key = prefix + py::str(name).cast<std::string>();
    const auto field =
        std::find_if(fields.begin(), fields.end(),
                     [&](const OptionField& candidate) { return candidate.key == key; });
    if (field != fields.end()) {
      std::visit(Assigner{key, value}, field->value);
    } else if (!IsGroup(key, fields)) {
      SetOptionField(key + "=" + py::str(value).cast<std::string>(), fields);  // names the nearest
    } else if (py::isinstance<py::dict>(value)) {
      SetGroup(key + ".", py::reinterpret_borrow<py::dict>(value), fields);
    } else {
      throw InputError(fmt::format("{}: got {}, expected a dict of options", key,
                                   py::repr(value).cast<std::string>()));
    }
  }
}

void AddSettings(const std::string& prefix, const py::dict& values,
                 std::vector<std::string>* settings) {
  for (const auto& [name, value] : values) {
    const std::string key = prefix + py::str(name).cast<std::string>();
    if (py::isinstance<py::dict>(value)) {
      AddSettings(key + ".", py::reinterpret_borrow<py::dict>(value), settings);
    } else if (py::isinstance<py::bool_>(value)) {
      settings->push_back(key + (value.cast<bool>() ? "=true" : "=false"));
    } else {
      settings->push_back(key + "=" + py::str(value).cast<std::string>());
    }
  }
}

// Empties the lines of the other groups; those that are left keep their numbers.
std::string WithoutOtherGroups(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  std::string kept;
  bool is_other = false;
  for (const std::string& line : lines) {
    const bool begins_group = !line.empty() && line[0] != ' ' && line[0] != '#';
    if (begins_group) is_other = kOtherGroups.contains(line.substr(0, line.find(':')));
    kept += (is_other ? "" : line) + "\n";
  }
  return kept;
}

}  // namespace

std::optional<std::string> PathOf(const py::object& options) {
  if (py::isinstance<py::str>(options)) return options.cast<std::string>();
  if (!py::hasattr(options, "__fspath__")) return std::nullopt;
  return options.attr("__fspath__")().cast<std::string>();
}

TaskOptions ReadConfiguration(const std::string& path) {
  TaskOptions file;
  ReadOptionFields(WithoutOtherGroups(ReadFile(path)), path, FieldsOf(file));
  return file;
}

void SetFields(const py::dict& values, const OptionFields& fields) { SetGroup("", values, fields); }

void WarnOf(const TargetOptions& target) {
  for (const std::string& warning : target.Warnings()) Warn(warning);
}

std::vector<std::string> Settings(const py::dict& values) {
  std::vector<std::string> settings;
  AddSettings("", values, &settings);
  return settings;
}

}  // namespace kestrel::python
