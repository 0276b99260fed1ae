// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/options/config_file.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <span>
#include <sstream>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/write_file.h"

namespace kestrel {
namespace {

using Names = std::span<const std::string>;

// A change of a text.
struct Edit {
  std::size_t begin = 0;
  std::size_t end = 0;  // end of the replaced text
  std::string text;
};

struct Setting {
  std::vector<std::string> names;  // parts of its key
  std::string value;               // as YAML
};

Setting ParseSetting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw InputError("'" + text + "': expected key=value");
  Setting setting;
  std::istringstream key(text.substr(0, equals));
  for (std::string name; std::getline(key, name, '.');) setting.names.push_back(name);
  setting.value = YAML::Dump(YAML::Node(text.substr(equals + 1)));
  return setting;
}

std::size_t LineEnd(const std::string& yaml, std::size_t place) {
  const std::size_t end = yaml.find('\n', place);
  return end == std::string::npos ? yaml.size() : end + 1;
}

// The lines of an option that is not there yet, the first one indented by 'column'.
std::string NewLines(Names names, const std::string& value, int column) {
  std::string lines;
  for (const std::string& name : names) {
    lines += fmt::format("{:{}}{}:", "", column, name);
    column += 2;
    if (&name != &names.back()) lines += "\n";
  }
  return lines + " " + value + "\n";
}

Edit Insertion(const std::string& yaml, std::size_t place, const std::string& lines) {
  const bool has_line_end = place == 0 || yaml[place - 1] == '\n';
  return {place, place, has_line_end ? lines : "\n" + lines};
}

// Returns the end of a value that begins at 'begin': behind its quotes, or before a comment.
std::size_t ValueEnd(const std::string& yaml, std::size_t begin) {
  const char quote = yaml[begin];
  if (quote == '"' || quote == '\'') {
    for (std::size_t i = begin + 1; i < yaml.size(); ++i) {
      if (quote == '"' && yaml[i] == '\\') {
        ++i;
      } else if (yaml[i] == quote) {
        return i + 1;
      }
    }
    return yaml.size();
  }
  std::size_t end = std::min(yaml.find(" #", begin), yaml.find('\n', begin));
  end = std::min(end, yaml.size());
  while (end > begin && std::isspace(static_cast<unsigned char>(yaml[end - 1]))) --end;
  return end;
}

// The change in the lines of 'group', of which 'names' are the rest of the key. 'place': where a
// line that is not there yet belongs.
Edit EditOf(const std::string& yaml, const YAML::Node& group, Names names, const std::string& value,
            std::size_t place) {
  for (const auto& entry : group) {
    if (entry.first.Scalar() != names.front()) continue;
    const Names rest = names.subspan(1);
    const YAML::Mark key = entry.first.Mark();
    const auto begin = static_cast<std::size_t>(entry.second.Mark().pos);
    if (rest.empty()) return {begin, ValueEnd(yaml, begin), value};
    const std::size_t next_line = LineEnd(yaml, static_cast<std::size_t>(key.pos));
    if (entry.second.IsNull()) {
      return Insertion(yaml, next_line, NewLines(rest, value, key.column + 2));
    }
    return EditOf(yaml, entry.second, rest, value, next_line);
  }
  const int column = group.size() == 0 ? 0 : group.begin()->first.Mark().column;
  return Insertion(yaml, place, NewLines(names, value, column));
}

// Returns all options that the text sets, as text.
std::string OptionsIn(const std::string& yaml, const std::string& file,
                      const std::string& setting = "") {
  KestrelOptions options;
  ReadOptionFields(yaml, file, FieldsOf(options));
  if (!setting.empty()) SetOption(setting, &options);
  return PrintOptions(options);
}

}  // namespace

std::string WithSetting(const std::string& yaml, const std::string& setting,
                        const std::string& file) {
  const std::string wanted = OptionsIn(yaml, file, setting);
  const auto [names, value] = ParseSetting(setting);
  const Edit edit = EditOf(yaml, LoadYaml(yaml, file), names, value, yaml.size());
  std::string changed = yaml;
  changed.replace(edit.begin, edit.end - edit.begin, edit.text);
  bool is_done = false;
  try {
    is_done = OptionsIn(changed, file) == wanted;
  } catch (const InputError&) {  // the change has made something else of it
  }
  if (is_done) return changed;
  throw InputError(
      fmt::format("{}: {} cannot be changed here, expected each option on a line of "
                  "its own, as `kestrel config` prints them",
                  file, setting.substr(0, setting.find('='))));
}

void SaveSettings(const std::string& file, const std::vector<std::string>& settings) {
  std::string yaml = ReadFile(file);
  for (const std::string& setting : settings) yaml = WithSetting(yaml, setting, file);
  // A link stays one.
  WriteFile(std::filesystem::canonical(file).string(), yaml);
}

}  // namespace kestrel
