// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/yaml_reader.h"

#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/shown.h"

namespace kestrel {
YamlReader::YamlReader(const std::string& text, const std::string& file)
    : YamlReader(LoadYaml(text, file), file, "") {}

YamlReader::YamlReader(const YAML::Node& node, std::string file, std::string key)
    : node_(std::make_shared<YAML::Node>(node)), file_(std::move(file)), key_(std::move(key)) {}

void YamlReader::Fail(const std::string& message) const {
  throw InputError(fmt::format("{}:{}: {}{}{}", file_, node_->Mark().line + 1, key_,
                               key_.empty() ? "" : ": ", message));
}

YamlReader YamlReader::operator[](const std::string& name) const {
  if (!Has(name)) Fail(fmt::format("'{}' is missing", name));
  const YAML::Node& map = *node_;
  return {map[name], file_, key_.empty() ? name : key_ + "." + name};
}

bool YamlReader::Has(const std::string& name) const {
  const YAML::Node& map = *node_;
  return map.IsMap() && map[name].IsDefined();
}

void YamlReader::RequireKeys(const std::set<std::string>& names) const {
  if (!node_->IsMap()) Fail("expected 'name: value'");
  std::set<std::string> seen;
  for (const auto& entry : *node_) {
    if (!entry.first.IsScalar()) Fail("expected 'name: value'");
    const std::string& name = entry.first.Scalar();
    if (!names.contains(name)) Fail(fmt::format("unknown key '{}'", Shown(name)));
    if (!seen.insert(name).second) Fail(fmt::format("'{}' is given twice", name));
  }
}

std::vector<YamlReader> YamlReader::Items() const {
  if (!node_->IsSequence()) Fail("expected a list");
  std::vector<YamlReader> items;
  for (const YAML::Node& item : *node_) {
    items.push_back(YamlReader(item, file_, fmt::format("{}[{}]", key_, items.size())));
  }
  return items;
}

std::string YamlReader::Text() const {
  if (!node_->IsScalar() || node_->Scalar().empty()) Fail("expected a word");
  return node_->Scalar();
}

double YamlReader::Number() const {
  const auto number = node_->IsScalar() ? ParseNumber<double>(node_->Scalar()) : std::nullopt;
  if (!number) Fail("expected a finite number");
  return *number;
}

std::int64_t YamlReader::Integer() const {
  const auto number = node_->IsScalar() ? ParseWhole<std::int64_t>(node_->Scalar()) : std::nullopt;
  if (!number) Fail("expected a whole number");
  return *number;
}

bool YamlReader::Bool() const {
  const std::string text = Text();
  if (text != "true" && text != "false") Fail("expected true or false");
  return text == "true";
}

std::vector<double> YamlReader::Numbers(std::size_t count) const {
  std::vector<double> numbers;
  for (const YamlReader& item : Items()) numbers.push_back(item.Number());
  if (numbers.size() != count) Fail(fmt::format("expected a list of {} numbers", count));
  return numbers;
}

}  // namespace kestrel
