// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/calibration_entry.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/shown.h"

namespace kestrel {

std::string PlainKey(const std::string& key) {
  std::string plain;
  for (const unsigned char c : key) {
    if (c != '_' && c != '-' && c != ' ') plain += static_cast<char>(std::tolower(c));
  }
  return plain;
}

CalibrationEntry::CalibrationEntry(const YAML::Node& root, const std::string& file)
    : CalibrationEntry(std::make_shared<File>(File{file, {}}), root, "") {}

CalibrationEntry::CalibrationEntry(std::shared_ptr<File> file, const YAML::Node& node,
                                   std::string key)
    : file_(std::move(file)), node_(node), key_(std::move(key)) {}

void CalibrationEntry::Fail(const std::string& what) const {
  const std::string line = node_.Mark().is_null() ? "" : fmt::format("{}:", node_.Mark().line + 1);
  const std::string subject = key_.empty() ? "the file" : fmt::format("'{}'", Shown(key_));
  throw InputError(fmt::format("{}:{} {} {}", file_->name, line, subject, what));
}

std::string CalibrationEntry::PathOf(const std::string& name) const {
  return key_.empty() ? name : key_ + "." + name;
}

void CalibrationEntry::RequireAgreement(const CalibrationEntry& other) const {
  const bool agrees = node_.IsScalar() && other.node_.IsScalar()
                          ? node_.Scalar() == other.node_.Scalar()
                          : Numbers() == other.Numbers();
  if (agrees) return;
  Fail(fmt::format("contradicts '{}', expected one of them", Shown(other.key_)));
}

std::optional<CalibrationEntry> CalibrationEntry::Find(Names names) const {
  if (!node_.IsMap()) Fail("is not a map of keys, expected one");
  const auto is_meant = [&](const std::string& key) {
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return PlainKey(name) == PlainKey(key); });
  };
  std::optional<CalibrationEntry> found;
  for (const auto& pair : node_) {
    if (!pair.first.IsScalar() || !is_meant(pair.first.Scalar())) continue;
    const CalibrationEntry child(file_, pair.second, PathOf(pair.first.Scalar()));
    file_->used.insert(child.key_);
    if (found && found->key_ == child.key_) {
      Fail(fmt::format("has '{}' twice, expected it once", Shown(pair.first.Scalar())));
    }
    if (found) child.RequireAgreement(*found);
    if (!found) found = child;
  }
  return found;
}

CalibrationEntry CalibrationEntry::Get(Names names, const std::string& expected) const {
  const std::optional<CalibrationEntry> child = Find(names);
  if (!child) {
    Fail(fmt::format("has no key '{}', expected {}", fmt::join(names, "' or '"), expected));
  }
  return *child;
}

std::string CalibrationEntry::Text() const {
  if (!node_.IsScalar()) Fail("is not a text, expected one");
  return node_.Scalar();
}

double CalibrationEntry::Number() const { return NumberOf(node_); }

int CalibrationEntry::Integer() const {
  const std::optional<int> number =
      node_.IsScalar() ? ParseWhole<int>(node_.Scalar()) : std::nullopt;
  if (!number) Fail("is not an integer, expected one");
  return *number;
}

std::vector<double> CalibrationEntry::Numbers() const {
  return node_.IsMap() ? MatrixNumbers() : ListNumbers();
}

std::vector<double> CalibrationEntry::Numbers(std::size_t count,
                                              const std::string& expected) const {
  std::vector<double> numbers = Numbers();
  if (numbers.size() != count) {
    Fail(fmt::format("has {} numbers, expected {}: {}", numbers.size(), count, expected));
  }
  return numbers;
}

double CalibrationEntry::NumberOf(const YAML::Node& node) const {
  if (!node.IsScalar()) Fail("holds something else than numbers, expected finite numbers");
  const std::optional<double> number = ParseNumber<double>(node.Scalar());
  if (!number) Fail(fmt::format("holds '{}', expected a finite number", Shown(node.Scalar())));
  return *number;
}

std::vector<double> CalibrationEntry::ListNumbers() const {
  if (!node_.IsSequence()) Fail("is not a list of numbers, expected one");
  std::vector<double> numbers;
  for (const YAML::Node& row : node_) {
    if (!row.IsSequence()) {
      numbers.push_back(NumberOf(row));
      continue;
    }
    for (const YAML::Node& number : row) numbers.push_back(NumberOf(number));
  }
  return numbers;
}

std::vector<double> CalibrationEntry::MatrixNumbers() const {
  std::vector<double> numbers = Get({"data"}, "the numbers of the matrix").ListNumbers();
  const std::int64_t rows = Get({"rows"}, "the number of rows").Integer();
  const std::int64_t cols = Get({"cols"}, "the number of columns").Integer();
  if (rows * cols != static_cast<std::int64_t>(numbers.size())) {
    Fail(fmt::format("has {} numbers, expected {} rows of {}", numbers.size(), rows, cols));
  }
  return numbers;
}

std::vector<std::string> CalibrationEntry::Keys() const {
  std::vector<std::string> keys;
  for (const auto& pair : node_) {
    if (pair.first.IsScalar()) keys.push_back(pair.first.Scalar());
  }
  return keys;
}

bool CalibrationEntry::IsUsed(const std::string& key) const {
  return file_->used.contains(PathOf(key));
}

}  // namespace kestrel
