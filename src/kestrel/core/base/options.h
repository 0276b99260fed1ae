// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "kestrel/core/base/limits.h"

namespace kestrel {

// Options are plain structs that describe each field once, in
//
//   static void Visit(auto& self, auto&& visit) {
//     visit("range_m", self.range_m, Range{0.5, 30}, "how far to look");
//     visit("gain", self.gain, "[1/s] speed per metre");
//     visit.Group("pattern", self.pattern);
//     visit.Gone({"old_name"});
//   }
//
// The unit follows from the end of the name (_m, _mps, ...), or leads the meaning. A field without
// limits may have any value of its type. What must hold between several fields is in
// `std::vector<std::string> Validate() const`, if there is such a thing; it is called when each
// field is within its limits.
//
// The functions below read, print and check such structs. A key is the path of names:
// "pattern.size_m".

using OptionValue = std::variant<bool*, int*, double*, std::string*>;

// One field of an options struct; 'value' points into the struct.
struct OptionField {
  std::string key;
  OptionValue value;
  Limits limits;
  std::string_view unit;  // empty where there is none
  std::string_view meaning;
};

// 'text': the meaning, behind a unit in brackets where that is not the one of the key's end.
OptionField MakeOptionField(const std::string& key, const OptionValue& value, const Limits& limits,
                            std::string_view text);

struct OptionFields : std::vector<OptionField> {
  std::vector<std::string> gone;  // keys and groups that former versions had
};

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
  void operator()(const char* name, Value& value, const Limits& limits, const char* meaning) {
    fields_->push_back(MakeOptionField(prefix_ + name, &value, limits, meaning));
  }
  template <class Value>
  void operator()(const char* name, Value& value, const char* meaning) {
    (*this)(name, value, {}, meaning);
  }
  template <class Options>
  void Group(const char* name, Options& options) {
    Options::Visit(options, OptionFieldCollector(fields_, prefix_ + name + "."));
  }
  // The fields of a part that has no name in the keys.
  template <class Options>
  void Group(Options& options) {
    Options::Visit(options, *this);
  }
  void Gone(std::initializer_list<const char*> names) {
    for (const char* name : names) fields_->gone.push_back(prefix_ + name);
  }

 private:
  OptionFields* fields_;
  std::string prefix_;
};

// A visitor that adds what is wrong with an options struct.
class ViolationCollector {
 public:
  explicit ViolationCollector(std::vector<std::string>* violations, std::string prefix = "")
      : violations_(violations), prefix_(std::move(prefix)) {}

  template <class Value>
  void operator()(const char* name, const Value& value, const Limits& limits,
                  const char* /*meaning*/) {
    if constexpr (!std::is_same_v<Value, bool>) Require(value, limits, prefix_ + name, violations_);
  }
  template <class Value>
  void operator()(const char* name, const Value& value, const char* meaning) {
    (*this)(name, value, {}, meaning);
  }
  template <class Options>
  void Group(const char* name, const Options& options) {
    ViolationCollector(violations_, prefix_ + name + ".").Group(options);
  }
  template <class Options>
  void Group(const Options& options) {
    const std::size_t count = violations_->size();
    if constexpr (requires { Options::Visit(options, *this); }) Options::Visit(options, *this);
    if constexpr (requires { options.Validate(); }) {
      if (violations_->size() > count) return;
      for (const std::string& violation : options.Validate()) {
        violations_->push_back(prefix_ + violation);
      }
    }
  }
  void Gone(std::initializer_list<const char*> /*names*/) {}

 private:
  std::vector<std::string>* violations_;
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

// Returns YAML with the unit, the meaning and the limits of every field as a comment. ReadOptions
// reads the same values from it, to the last bit.
template <class Options>
std::string PrintOptions(Options options) {
  return PrintOptionFields(FieldsOf(options));
}

// Returns every violation in words: of the limits of the fields and of Validate().
template <class Options>
std::vector<std::string> ViolationsOf(const Options& options) {
  std::vector<std::string> violations;
  ViolationCollector(&violations).Group(options);
  return violations;
}

// Throws InputError with all violations.
template <class Options>
void RequireValid(const Options& options) {
  ThrowIfAny(ViolationsOf(options));
}

// The same for initializers of a constructor: returns the options.
template <class Options>
const Options& Checked(const Options& options) {
  RequireValid(options);
  return options;
}

}  // namespace kestrel
