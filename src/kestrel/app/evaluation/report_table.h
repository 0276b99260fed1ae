// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/evaluation/statistics.h"

namespace kestrel {

// A table of a report, as text; each row has as many cells as 'columns'.
struct ReportTable {
  std::string name;  // file name without the extension
  std::string title;
  std::string note;  // one line under the title; may be empty
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

// Returns a section of Markdown: title, note, table.
std::string ToMarkdown(const ReportTable& table);

// Returns CSV with a header row; unknown values are empty.
std::string ToCsv(const ReportTable& table);

// Text of a cell whose value is unknown.
inline constexpr char kUnknownCell[] = "-";

// Returns 'value' with 'decimals' digits after the point; kUnknownCell for NaN.
std::string FormatFixed(double value, int decimals);

// Returns a share of 0 to 1, or an interval of shares, in percent: "97.2 to 98.8".
std::string FormatPercent(double share);
std::string FormatPercent(const Interval& shares);

}  // namespace kestrel
