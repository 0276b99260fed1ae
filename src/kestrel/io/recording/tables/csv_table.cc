// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/csv_table.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"

namespace kestrel {
namespace {

constexpr std::string_view kBlanks = " \t\r";

std::string_view Trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Editors of Windows put it before UTF-8.
std::string_view WithoutByteOrderMark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

std::vector<std::string_view> SplitCells(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t end = line.find(',', begin);
    cells.push_back(Trim(line.substr(begin, end - begin)));
    if (end == std::string_view::npos) return cells;
    begin = end + 1;
  }
}

std::string WithoutBlanks(std::string_view text) {
  std::string kept(text);
  std::erase_if(kept, [](char c) { return kBlanks.find(c) != std::string_view::npos; });
  return kept;
}

}  // namespace

CsvTable::CsvTable(std::string_view text, std::string file) : file_(std::move(file)) {
  text = WithoutByteOrderMark(text);
  for (std::size_t line = 1, begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    AddLine(line, Trim(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  if (header_.empty()) throw InputError(file_ + ": is empty, expected a header row");
}

void CsvTable::AddLine(std::size_t line, std::string_view content) {
  if (content.empty()) return;
  if (header_.empty()) {
    if (content.front() == '#') content.remove_prefix(1);
    header_ = SplitCells(content);
    return;
  }
  rows_.push_back({line, SplitCells(content)});
  if (const std::size_t width = rows_.back().cells.size(); width != header_.size()) {
    Fail(rows_.size() - 1,
         fmt::format("{} columns, expected {} as in the header", width, header_.size()));
  }
}

std::size_t CsvTable::Column(std::string_view name) const {
  if (const auto found = FindColumn(name)) return *found;
  throw InputError(fmt::format("{}: no column '{}', the header row has '{}'", file_, name,
                               fmt::join(header_, ",")));
}

std::optional<std::size_t> CsvTable::FindColumn(std::string_view name) const {
  const std::string wanted = WithoutBlanks(name);
  const auto found = std::find_if(header_.begin(), header_.end(), [&](std::string_view column) {
    return WithoutBlanks(column) == wanted;
  });
  if (found == header_.end()) return std::nullopt;
  return found - header_.begin();
}

std::string_view CsvTable::Text(std::size_t row, std::size_t column) const {
  if (rows_[row].cells[column].empty()) FailCell(row, column, "a text");
  return rows_[row].cells[column];
}

double CsvTable::Number(std::size_t row, std::size_t column) const {
  const auto number = ParseNumber<double>(rows_[row].cells[column]);
  if (!number) FailCell(row, column, "a finite number");
  return *number;
}

std::int64_t CsvTable::Integer(std::size_t row, std::size_t column) const {
  const auto number = ParseNumber<std::int64_t>(rows_[row].cells[column]);
  if (!number) FailCell(row, column, "a whole number");
  return *number;
}

bool CsvTable::IsEmpty(std::size_t row, std::size_t column) const {
  return rows_[row].cells[column].empty();
}

std::optional<double> CsvTable::OptionalNumber(std::size_t row, std::size_t column) const {
  if (IsEmpty(row, column)) return std::nullopt;
  return Number(row, column);
}

void CsvTable::Fail(std::size_t row, const std::string& message) const {
  throw InputError(fmt::format("{}: line {}: {}", file_, rows_[row].line, message));
}

void CsvTable::FailCell(std::size_t row, std::size_t column, const char* expected) const {
  Fail(row,
       fmt::format("{} is '{}', expected {}", header_[column], rows_[row].cells[column], expected));
}

std::string CsvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

}  // namespace kestrel
