// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace kestrel {

// Options are plain structs that name their fields once, in
//
//   template <class Self, class Visitor> static void Visit(Self& self, Visitor&& visitor) {
//     visitor("range_m", self.range_m, "m", "how far to look");
//     visitor.Group("pattern", self.pattern);
//   }
//   std::vector<std::string> Validate() const;
//
// The functions below read and print such structs. A key is the path of names: "pattern.size_m".

// One field of an options struct; 'value' points into the struct.
struct OptionField {
  std::string key;
  std::variant<bool*, int*, double*, std::string*> value;
  std::string_view unit;  // "1" for a pure number, empty where there is no unit
  std::string_view meaning;
};
using OptionFields = std::vector<OptionField>;

// The untyped implementations of the functions below.
void ReadOptionFile(const std::string& path, const OptionFields& fields);
void ReadOptionFields(const std::string& yaml, const std::string& file, const OptionFields& fields);
void SetOptionField(const std::string& assignment, const OptionFields& fields);
std::string PrintOptionFields(const OptionFields& fields);
void ThrowIfAny(const std::vector<std::string>& violations);

// A visitor that collects the fields of an options struct with their keys.
class OptionFieldCollector {
 public:
  explicit OptionFieldCollector(OptionFields* fields, std::string prefix = "")
      : fields_(fields), prefix_(std::move(prefix)) {}

  template <class Value>
  void operator()(const char* name, Value& value, const char* unit, const char* meaning) {
    fields_->push_back({prefix_ + name, &value, unit, meaning});
  }
  template <class Options>
  void Group(const char* name, Options& options) {
    Options::Visit(options, OptionFieldCollector(fields_, prefix_ + name + "."));
  }

 private:
  OptionFields* fields_;
  std::string prefix_;
};

// Returns all fields of 'options', in the order of Visit. They point into 'options'.
template <class Options>
OptionFields FieldsOf(Options& options) {
  static_assert(!std::is_const_v<Options>);
  OptionFields fields;
  Options::Visit(options, OptionFieldCollector(&fields));
  return fields;
}

// Sets the fields that the YAML file names and leaves the others. Throws InputError with file and
// line for an unknown key (and names the nearest one), a duplicate key, or a value of the wrong
// type.
template <class Options>
void ReadOptions(const std::string& path, Options* options) {
  ReadOptionFile(path, FieldsOf(*options));
}

// Sets one field by "key=value". Throws InputError as ReadOptions does.
template <class Options>
void SetOption(const std::string& assignment, Options* options) {
  SetOptionField(assignment, FieldsOf(*options));
}

// Returns YAML with the unit and the meaning of every field as a comment. ReadOptions reads the
// same values from it, to the last bit.
template <class Options>
std::string PrintOptions(Options options) {
  return PrintOptionFields(FieldsOf(options));
}

// Throws InputError with all violations that Validate() reports.
template <class Options>
void RequireValid(const Options& options) {
  ThrowIfAny(options.Validate());
}

// The same for initializers of a constructor: returns the options.
template <class Options>
const Options& Checked(const Options& options) {
  RequireValid(options);
  return options;
}

}  // namespace kestrel
