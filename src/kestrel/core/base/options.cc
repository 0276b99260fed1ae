// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/options.h"

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/edit_distance.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/read_file.h"

namespace kestrel {
namespace {

constexpr int kMeaningColumn = 36;

// Ends of names and the units of their values; the first one that fits.
constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
    {"_mps2", "m/s^2"}, {"_mps", "m/s"}, {"_dps", "deg/s"}, {"_radps", "rad/s"},
    {"_deg", "deg"},    {"_hz", "Hz"},   {"_px", "px"},     {"_ms", "ms"},
    {"_mb", "MB"},      {"_ppm", "ppm"}, {"_m", "m"},       {"_s", "s"}};

std::optional<bool> ParseBool(const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  return std::nullopt;
}

template <class Value>
bool Assign(const std::optional<Value>& parsed, Value* value) {
  if (parsed) *value = *parsed;
  return parsed.has_value();
}

struct Assigner {
  const std::string& text;
  bool operator()(bool* value) const { return Assign(ParseBool(text), value); }
  bool operator()(int* value) const { return Assign(ParseWhole<int>(text), value); }
  bool operator()(double* value) const { return Assign(ParseNumber<double>(text), value); }
  bool operator()(std::string* value) const { return Assign(std::optional(text), value); }
};

struct TypeName {
  const char* operator()(bool*) const { return "true or false"; }
  const char* operator()(int*) const { return "a whole number"; }
  const char* operator()(double*) const { return "a finite number"; }
  const char* operator()(std::string*) const { return "a word"; }
};

std::string Expected(const OptionField& field) {
  return fmt::format("expected {}{}", std::visit(TypeName(), field.value),
                     field.unit.empty() ? "" : fmt::format(" ({})", field.unit));
}

void AssignText(const std::string& text, const std::string& where, const OptionField& field) {
  if (std::visit(Assigner{text}, field.value)) return;
  throw InputError(fmt::format("{}: {} is '{}', {}{}", where, field.key, text, Expected(field),
                               DecimalCommaAdvice(text)));
}

std::pair<std::string_view, std::string_view> SplitLast(std::string_view key) {
  const std::size_t dot = key.rfind('.');
  if (dot == std::string_view::npos) return {"", key};
  return {key.substr(0, dot), key.substr(dot + 1)};
}

// A misspelt name weighs more than the right name in the wrong group.
int KeyDistance(std::string_view a, std::string_view b) {
  const auto [group_a, name_a] = SplitLast(a);
  const auto [group_b, name_b] = SplitLast(b);
  return 2 * EditDistance(name_a, name_b) + (group_a == group_b ? 0 : 1);
}

// Returns the keys of all fields and of the groups that contain them.
std::set<std::string> AllKeys(const OptionFields& fields) {
  std::set<std::string> keys;
  for (const OptionField& field : fields) {
    for (std::string_view key = field.key; !key.empty(); key = SplitLast(key).first) {
      keys.emplace(key);
    }
  }
  return keys;
}

[[noreturn]] void ThrowUnknownKey(const std::string& key, const std::string& where,
                                  const OptionFields& fields) {
  const std::set<std::string> keys = AllKeys(fields);
  const auto nearest =
      std::min_element(keys.begin(), keys.end(), [&](const std::string& a, const std::string& b) {
        return KeyDistance(key, a) < KeyDistance(key, b);
      });
  const bool is_near = IsNearName(SplitLast(key).second, SplitLast(*nearest).second);
  throw InputError(fmt::format("{}: unknown key '{}'{}", where, key,
                               is_near ? fmt::format(", did you mean '{}'?", *nearest) : ""));
}

const OptionField* FindField(const std::string& key, const OptionFields& fields) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const OptionField& field) { return field.key == key; });
  return found == fields.end() ? nullptr : &*found;
}

bool IsGroup(const std::string& key, const OptionFields& fields) {
  return std::any_of(fields.begin(), fields.end(),
                     [&](const OptionField& field) { return field.key.starts_with(key + "."); });
}

std::string Where(const std::string& file, const YAML::Node& node) {
  return fmt::format("{}:{}", file, node.Mark().line + 1);
}

bool IsGone(const std::string& key, const OptionFields& fields) {
  return std::any_of(fields.gone.begin(), fields.gone.end(), [&](const std::string& gone) {
    return key == gone || key.starts_with(gone + ".");
  });
}

[[noreturn]] void ThrowGone(const std::string& where, const std::vector<std::string>& keys) {
  throw InputError(
      fmt::format("{}: {}: no option any more, remove it (docs/versions.md has what holds instead)",
                  where, fmt::join(keys, ", ")));
}

// Adds the keys that former versions had to 'gone'.
void ReadGroup(const YAML::Node& group, const std::string& prefix, const std::string& file,
               const OptionFields& fields, std::vector<std::string>* gone) {
  std::set<std::string> seen;
  for (const auto& entry : group) {
    const YAML::Node& name = entry.first;
    const YAML::Node& value = entry.second;
    const std::string where = Where(file, name);
    if (!name.IsScalar()) throw InputError(where + ": expected 'name: value'");
    const std::string key = prefix + name.Scalar();
    if (!seen.insert(key).second)
      throw InputError(fmt::format("{}: {} is given twice", where, key));
    if (const OptionField* field = FindField(key, fields)) {
      if (!value.IsScalar()) {
        throw InputError(fmt::format("{}: {}: {}", where, key, Expected(*field)));
      }
      AssignText(value.Scalar(), where, *field);
    } else if (IsGone(key, fields)) {
      gone->push_back(key);
    } else if (!IsGroup(key, fields)) {
      ThrowUnknownKey(key, where, fields);
    } else if (value.IsMap()) {
      ReadGroup(value, key + ".", file, fields, gone);
    } else if (!value.IsNull()) {
      throw InputError(fmt::format("{}: {}: expected a group of options", where, key));
    }
  }
}

struct ValuePrinter {
  std::string operator()(const bool* value) const { return *value ? "true" : "false"; }
  std::string operator()(const int* value) const { return fmt::to_string(*value); }
  std::string operator()(const double* value) const { return fmt::to_string(*value); }
  // In quotes where YAML would read something else.
  std::string operator()(const std::string* value) const { return YAML::Dump(YAML::Node(*value)); }
};

std::vector<std::string> SplitKey(const std::string& key) {
  std::vector<std::string> names;
  std::istringstream stream(key);
  for (std::string name; std::getline(stream, name, '.');) names.push_back(name);
  return names;
}

}  // namespace

OptionField MakeOptionField(const std::string& key, const OptionValue& value, const Limits& limits,
                            std::string_view text) {
  OptionField field{key, value, limits, "", text};
  if (text.starts_with('[')) {
    const std::size_t end = text.find("] ");
    field.unit = text.substr(1, end - 1);
    field.meaning = text.substr(end + 2);
    return field;
  }
  const auto* const unit = std::find_if(std::begin(kUnits), std::end(kUnits),
                                        [&](const auto& one) { return key.ends_with(one.first); });
  if (unit != std::end(kUnits)) field.unit = unit->second;
  return field;
}

void ReadOptionFile(const std::string& path, const OptionFields& fields) {
  ReadOptionFields(ReadFile(path), path, fields);
}

void ReadOptionFields(const std::string& yaml, const std::string& file,
                      const OptionFields& fields) {
  const YAML::Node root = LoadYaml(yaml, file);
  if (root.IsNull()) return;
  if (!root.IsMap()) throw InputError(file + ": expected 'name: value' lines (YAML)");
  std::vector<std::string> gone;
  ReadGroup(root, "", file, fields, &gone);
  if (!gone.empty()) ThrowGone(file, gone);
}

void SetOptionField(const std::string& assignment, const OptionFields& fields) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw InputError("'" + assignment + "': expected key=value");
  }
  const std::string key = assignment.substr(0, equals);
  const OptionField* field = FindField(key, fields);
  if (!field && IsGroup(key, fields)) {
    throw InputError(
        fmt::format("'{}': {} is a group of options, expected one of them", assignment, key));
  }
  if (!field && IsGone(key, fields)) ThrowGone("'" + assignment + "'", {key});
  if (!field) ThrowUnknownKey(key, "'" + assignment + "'", fields);
  AssignText(assignment.substr(equals + 1), "'" + assignment + "'", *field);
}

std::string PrintOptionFields(const OptionFields& fields) {
  std::string text;
  std::vector<std::string> open;  // the groups that the last field is in
  for (const OptionField& field : fields) {
    std::vector<std::string> names = SplitKey(field.key);
    const std::string name = names.back();
    names.pop_back();
    const auto differs = std::mismatch(open.begin(), open.end(), names.begin(), names.end()).second;
    for (auto group = differs; group != names.end(); ++group) {
      text += fmt::format("{:{}}{}:\n", "", 2 * (group - names.begin()), *group);
    }
    const std::string line = fmt::format("{:{}}{}: {}", "", 2 * names.size(), name,
                                         std::visit(ValuePrinter(), field.value));
    const std::string limits = ToString(field.limits);
    text += fmt::format("{:<{}}  # {}{}{}\n", line, kMeaningColumn,
                        field.unit.empty() ? "" : fmt::format("[{}] ", field.unit), field.meaning,
                        limits.empty() ? "" : fmt::format(" ({})", limits));
    open = std::move(names);
  }
  return text;
}

void ThrowIfAny(const std::vector<std::string>& violations) {
  if (!violations.empty()) throw InputError(fmt::format("{}", fmt::join(violations, "; ")));
}

}  // namespace kestrel
