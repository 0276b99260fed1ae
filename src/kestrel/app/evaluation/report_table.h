// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/evaluation/statistics.h"

namespace kestrel {

// A table of a report, as text; every row is as wide as 'columns'.
struct ReportTable {
  std::string name;  // of its file, without the ending
  std::string title;
  std::string note;  // one line under the title; may be empty
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

// A Markdown section: title, note, table.
std::string ToMarkdown(const ReportTable& table);

// CSV with a header row; a value that is not known is left empty.
std::string ToCsv(const ReportTable& table);

// What stands in a cell for a value that is not known.
inline constexpr char kUnknownCell[] = "-";

// 'value' with 'decimals' digits after the point; kUnknownCell for NaN.
std::string FormatFixed(double value, int decimals);

// A share 0 to 1 as percent, and an interval of it, "97.2 to 98.8".
std::string FormatPercent(double share);
std::string FormatPercent(const Interval& shares);

}  // namespace kestrel
