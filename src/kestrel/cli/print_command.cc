// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/cli/print_command.h"

#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "kestrel/cli/option_arguments.h"
#include "kestrel/print/pattern_print.h"
#include "kestrel/recording/output_folder.h"

namespace kestrel {
namespace {

constexpr char kPdf[] = ".pdf", kSvg[] = ".svg";

struct PrintArguments {
  OptionArguments options;
  std::string paper;
  std::string output = ".";
  bool force = false;
};

// Paths of new files, which are named as they are made.
class PrintFiles {
 public:
  PrintFiles(const std::filesystem::path& folder, bool force) : folder_(folder, force) {}

  std::string New(const std::string& name) const {
    std::string path = folder_.NewFile(name).lexically_normal().string();
    fmt::print(stderr, "{}\n", path);
    return path;
  }
  std::string NewQuietly(const std::string& name) const { return folder_.NewFile(name).string(); }

 private:
  OutputFolder folder_;
};

void PrintWhole(const LandingPattern& pattern, const std::string& name, const std::string& kind,
                const PrintFiles& files) {
  if (kind != kSvg) PrintPatternPdf(pattern, files.New(name + kPdf));
  if (kind != kPdf) PrintPatternSvg(pattern, files.New(name + kSvg));
}

// The SVGs, of one page each, in a folder.
void PrintTiled(const LandingPattern& pattern, const Tiling& tiling, const std::string& name,
                const std::string& kind, const PrintFiles& files) {
  if (kind != kSvg) PrintTilesPdf(pattern, tiling, files.New(name + kPdf));
  if (kind == kPdf) return;
  PrintOverviewSvg(pattern, tiling, files.New(name + "/overview" + kSvg));
  for (int row = 0; row < tiling.rows; ++row) {
    for (int column = 0; column < tiling.columns; ++column) {
      PrintTileSvg(pattern, tiling, row, column,
                   files.NewQuietly(
                       fmt::format("{}/sheet_{}.{}{}", name, row + 1, column + 1, kSvg)));
    }
  }
  fmt::print(stderr, "and beside it {} sheets, {} rows of {}\n", tiling.count(), tiling.rows,
             tiling.columns);
}

void RunPrint(const PrintArguments& arguments) {
  const LandingPattern pattern = arguments.options.Read().landing.detector.pattern;
  const std::filesystem::path output(arguments.output);
  const std::string kind = output.extension().string();
  const bool is_file = kind == kPdf || kind == kSvg;
  const PrintFiles files(is_file ? output.parent_path() / "." : output, arguments.force);
  if (arguments.paper.empty()) {
    const std::string name = is_file ? output.stem().string() : "landing_pattern";
    PrintWhole(pattern, name, is_file ? kind : "", files);
    return;
  }
  const Tiling tiling = TileBoard(pattern.board_size_m, *PaperSize(arguments.paper));
  const std::string name =
      is_file ? output.stem().string() : "landing_pattern_" + arguments.paper;
  PrintTiled(pattern, tiling, name, is_file ? kind : "", files);
}

}  // namespace

void AddPrintCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand(
      "print", "The configured landing pattern as PDF and SVG, true to scale");
  const auto arguments = std::make_shared<PrintArguments>();
  arguments->options.AddTo(command);
  command
      ->add_option("--paper", arguments->paper,
                   "Cut into tiles for sheets of this size (a0 to a4), else one page as large as "
                   "the board")
      ->type_name("SIZE")
      ->check(CLI::IsMember(PaperNames()));
  command
      ->add_option("--output", arguments->output,
                   "A folder for both formats (else this one), or a file that ends in .pdf or .svg")
      ->type_name("FILE|DIR");
  command->add_flag("--force", arguments->force, "Replace files that exist");
  command->callback([arguments] { RunPrint(*arguments); });
}

}  // namespace kestrel
