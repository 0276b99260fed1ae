// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/app/evaluation/plot.h"
#include "kestrel/app/evaluation/report_table.h"
#include "kestrel/io/recording/output_folder.h"

namespace kestrel {

// The result of an evaluation.
struct Report {
  std::string title;
  std::vector<ReportTable> tables;
  std::vector<Plot> plots;
};

// Returns the tables as one page of Markdown.
std::string ToMarkdown(const Report& report);

// Writes report.md, one CSV per table and one PNG per plot. Throws InputError when a file exists
// and may not be replaced, or cannot be written.
void WriteReport(const Report& report, const OutputFolder& folder);

}  // namespace kestrel
