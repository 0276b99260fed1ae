// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/report_table.h"

#include <cmath>

#include <fmt/format.h>

#include "kestrel/io/recording/tables/csv_table.h"

namespace kestrel {
namespace {

std::string MarkdownRow(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string CsvRow(const std::vector<std::string>& cells) {
  std::vector<std::string> quoted;
  for (const std::string& cell : cells) quoted.push_back(cell == kUnknownCell ? "" : CsvCell(cell));
  return fmt::format("{}\n", fmt::join(quoted, ","));
}

}  // namespace

std::string ToMarkdown(const ReportTable& table) {
  std::string text = fmt::format("## {}\n\n", table.title);
  if (!table.note.empty()) text += table.note + "\n\n";
  text += MarkdownRow(table.columns);
  text += MarkdownRow(std::vector<std::string>(table.columns.size(), "---"));
  for (const auto& row : table.rows) text += MarkdownRow(row);
  return text;
}

std::string ToCsv(const ReportTable& table) {
  std::string text = CsvRow(table.columns);
  for (const auto& row : table.rows) text += CsvRow(row);
  return text;
}

std::string FormatFixed(double value, int decimals) {
  return std::isnan(value) ? kUnknownCell : fmt::format("{:.{}f}", value, decimals);
}

std::string FormatPercent(double share) { return FormatFixed(100 * share, 1); }

std::string FormatPercent(const Interval& shares) {
  return FormatPercent(shares.low) + " to " + FormatPercent(shares.high);
}

}  // namespace kestrel
