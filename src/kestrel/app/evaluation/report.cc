// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/report.h"

#include <fmt/format.h>

namespace kestrel {

std::string ToMarkdown(const Report& report) {
  std::string text = fmt::format("# {}\n", report.title);
  for (const ReportTable& table : report.tables) {
    if (!table.rows.empty()) text += fmt::format("\n{}", ToMarkdown(table));
  }
  return text;
}

void WriteReport(const Report& report, const OutputFolder& folder) {
  std::string page = ToMarkdown(report);
  for (const Plot& plot : report.plots) {
    page += fmt::format("\n![{}]({}.png)\n", plot.title, plot.name);
  }
  folder.OpenText("report.md") << page;
  for (const ReportTable& table : report.tables) {
    if (!table.rows.empty()) folder.OpenText(table.name + ".csv") << ToCsv(table);
  }
  for (const Plot& plot : report.plots) WritePlot(plot, folder.NewFile(plot.name + ".png"));
}

}  // namespace kestrel
