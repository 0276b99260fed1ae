// SPDX-License-Identifier: BSD-3-Clause
// Prints how well coloured objects are found: on the real frame, on the independently rendered
// flights, and on your own recordings with truth.
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "hunt_score.h"
#include "kestrel/app/evaluation/object_tables.h"
#include "report_main.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

void PrintReal(const fs::path& folder) {
  const RealFrameScore score = ScoreRealFrame(folder.string());
  fmt::print("\n## hunt_real\n\n| annotated | found as | centre, px |\n|---|---|---|\n");
  for (const RealDisc& disc : score.discs) {
    const bool is_found = !disc.found_as.empty();
    fmt::print("| {} | {} | {} |\n", disc.color, is_found ? disc.found_as : "-",
               is_found ? fmt::format("{:.2f}", disc.center_error_px) : "-");
  }
  fmt::print("\n{} detections in all, and {} that may be several discs\n", score.single,
             score.merged);
}

ReportTable CenterTable(const HuntScore& score) {
  ReportTable table{
      "centers", "Centres", "", {"objects found", "count", "centre median, px", "95 %, px"}, {}};
  for (const auto& [kind, errors_px] : score.center_errors_px) {
    table.rows.push_back({kind, std::to_string(errors_px.size()), FormatFixed(Median(errors_px), 2),
                          FormatFixed(Quantile(errors_px, 0.95), 2)});
  }
  return table;
}

void PrintFlight(const fs::path& folder) {
  const HuntScore score = ScoreHunt(folder.string());
  fmt::print("\n# {}\n\n{}", folder.string(), ToMarkdown(DetectionTable(score.comparisons)));
  fmt::print("\n{}", ToMarkdown(CenterTable(score)));
  if (score.digits.count == 0) return;
  fmt::print("\nDigits right (6 and 9 as one): {} of {}, at 3 m and less {} of {}\n",
             score.digits.right, score.digits.count, score.near_digits.right,
             score.near_digits.count);
}

void Run(const fs::path& data, const std::vector<std::string>& recordings) {
  for (const std::string& recording : recordings) PrintFlight(recording);
  if (!recordings.empty()) return;
  if (fs::exists(data / "hunt_real")) PrintReal(data / "hunt_real");
  for (const char* name : {"discs", "cuboids"}) {
    const fs::path folder = data / "hunt_hard" / name;
    if (fs::exists(folder)) PrintFlight(folder);
  }
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Accuracy of the coloured-object pipeline");
  std::string data = KESTREL_DATA_DIR;
  std::vector<std::string> recordings;
  app.add_option("--data", data, "Folder with hunt_real and hunt_hard");
  app.add_option("recordings", recordings, "Recordings with objects0, in place of these");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Run(data, recordings);
    return 0;
  });
}
