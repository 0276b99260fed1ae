// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/option_arguments.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/calibration/print/pattern_print.h"
#include "kestrel/calibration/print/print_check.h"
#include "kestrel/calibration/print/print_measurement.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/recording/image_file.h"
#include "kestrel/io/recording/output_folder.h"

namespace kestrel {
namespace {

constexpr char kPdf[] = ".pdf", kSvg[] = ".svg";

struct PrintArguments {
  OptionArguments options;
  std::string paper;
  std::string output = ".";
  bool force = false;
  std::string photo;  // checked instead of printing
  std::string camera;
  std::optional<double> distance_m;
  std::optional<double> ruler_m;
};

// New files in one folder. The command prints the name of each when it is written.
class PrintFiles {
 public:
  PrintFiles(const std::filesystem::path& folder, bool force) : folder_(folder, force) {}

  // Calls 'write' with the path and returns the path.
  template <class Write>
  std::string Add(const std::string& name, Write&& write) const {
    const std::filesystem::path path = folder_.NewFile(name);
    write(path.string());
    return path.lexically_normal().string();
  }

 private:
  OutputFolder folder_;
};

void PrintWhole(const TargetPrint& print, const std::string& name, const std::string& kind,
                const PrintFiles& files) {
  using Write = void (*)(const TargetPrint&, const std::string&);
  const auto add = [&](const char* end, Write write) {
    const std::string path =
        files.Add(name + end, [&](const std::string& file) { write(print, file); });
    fmt::print(stderr, "{}\n", path);
  };
  if (kind != kSvg) add(kPdf, PrintPatternPdf);
  if (kind != kPdf) add(kSvg, PrintPatternSvg);
}

// Writes the SVGs, of one page each, to a folder.
void PrintTiled(const TargetPrint& print, const Tiling& tiling, const std::string& name,
                const std::string& kind, const PrintFiles& files) {
  if (kind != kSvg) {
    const std::string path = files.Add(
        name + kPdf, [&](const std::string& file) { PrintTilesPdf(print, tiling, file); });
    fmt::print(stderr, "{}: {}\n", path, SheetsInWords(print, tiling));
  }
  if (kind == kPdf) return;
  const std::string overview = files.Add(name + "/overview" + kSvg, [&](const std::string& file) {
    PrintOverviewSvg(print, tiling, file);
  });
  for (int row = 0; row < tiling.rows; ++row) {
    for (int column = 0; column < tiling.columns; ++column) {
      if (!HasPrint(print, tiling, row, column)) continue;
      files.Add(fmt::format("{}/sheet_{}.{}{}", name, row + 1, column + 1, kSvg),
                [&](const std::string& file) { PrintTileSvg(print, tiling, row, column, file); });
    }
  }
  fmt::print(stderr, "{}, and its sheets beside it\n", overview);
}

PrintMeasurement Measure(const PrintArguments& arguments,
                         const LandingPatternDetectorOptions& detector) {
  const cv::Mat photo = ReadGrayImage(arguments.photo);
  std::optional<CameraIntrinsics> camera;
  if (!arguments.camera.empty()) {
    camera = ReadCalibration(arguments.camera).intrinsics;
    CheckImageSize(*camera, photo.cols, photo.rows, arguments.photo);
  }
  const std::optional<PrintMeasurement> print = MeasurePrint(photo, camera, detector);
  if (print) return *print;
  throw InputError(fmt::format(
      "{}: no landing pattern that can be measured: take the photograph from nearer, sharp, with "
      "all of the ring in view{}; a print that is squeezed in one direction or not flat cannot be "
      "measured either",
      arguments.photo, camera ? "" : ", and give the camera's calibration by --camera"));
}

std::optional<PrintScale> ScaleOf(const PrintArguments& arguments, const LandingPattern& pattern,
                                  const PrintMeasurement& print) {
  if (arguments.ruler_m) return ScaleByRuler(*arguments.ruler_m, pattern);
  if (arguments.distance_m) return ScaleByDistance(*arguments.distance_m, print);
  return std::nullopt;
}

void CheckPhoto(const PrintArguments& arguments) {
  const LandingPatternDetectorOptions detector = arguments.options.Read().landing.detector;
  const PrintMeasurement print = Measure(arguments, detector);
  const std::optional<PrintScale> scale = ScaleOf(arguments, detector.pattern, print);
  fmt::print("{}: the ring is {:.0f} px wide, {:.2f} mm a pixel\n", arguments.photo, print.ring_px,
             1000 * print.pixel_m);
  const std::vector<CheckedDimension> dimensions = CheckPrint(detector.pattern, print, scale);
  fmt::print("{}", DimensionsTable(dimensions));
  if (!scale) {
    fmt::print(
        "All in proportion to the ring's outer diameter: a photograph has no scale, --ruler or "
        "--distance give it one.\n");
  }
  std::fflush(stdout);
  RequireAsConfigured(arguments.photo, dimensions);
}

void RunPrint(const PrintArguments& arguments) {
  if (!arguments.photo.empty()) {
    CheckPhoto(arguments);
    return;
  }
  const LandingPipelineOptions landing = arguments.options.Read().landing;
  const TargetPrint print = PrintOfTarget(landing.target, landing.detector.pattern);
  const std::filesystem::path output(arguments.output);
  const std::string kind = output.extension().string();
  const bool is_file = kind == kPdf || kind == kSvg;
  if (!is_file && !kind.empty() && !std::filesystem::is_directory(output)) {
    throw InputError(
        arguments.output +
        ": expected a name that ends in .pdf or .svg, or a folder's without an ending");
  }
  const PrintFiles files(is_file ? output.parent_path() / "." : output, arguments.force);
  if (arguments.paper.empty()) {
    const std::string name = is_file ? output.stem().string() : "landing_pattern";
    PrintWhole(print, name, is_file ? kind : "", files);
    return;
  }
  const Tiling tiling = TileBoard(print.board_size_m, *PaperSize(arguments.paper));
  const std::string name = is_file ? output.stem().string() : "landing_pattern_" + arguments.paper;
  PrintTiled(print, tiling, name, is_file ? kind : "", files);
}

CLI::Option* AddCheckOptions(CLI::App* command, PrintArguments* arguments) {
  CLI::Option* const check = command
                                 ->add_option("--check", arguments->photo,
                                              "Photograph of a print: compare its dimensions with "
                                              "the configured ones, and print nothing")
                                 ->type_name("IMAGE");
  CLI::Option* const camera =
      command
          ->add_option("--camera", arguments->camera,
                       "Calibration of the photograph's camera (default: no distortion)")
          ->type_name("FILE")
          ->needs(check);
  CLI::Option* const ruler =
      command->add_option("--ruler", arguments->ruler_m, "Measured length of the printed ruler (m)")
          ->type_name("M")
          ->check(InRange(0, 10, "a positive length in m"))
          ->needs(check);
  command
      ->add_option("--distance", arguments->distance_m,
                   "Measured distance from the camera to the middle of the print (m)")
      ->type_name("M")
      ->check(InRange(0, 1000, "a positive length in m"))
      ->needs(camera)
      ->excludes(ruler);
  return check;
}

}  // namespace

void AddPrintCommand(CLI::App* app) {
  CLI::App* command =
      app->add_subcommand("print", "The configured pad as PDF and SVG, true to scale");
  const auto arguments = std::make_shared<PrintArguments>();
  arguments->options.AddTo(command);
  arguments->options.target.AddTo(command);
  CLI::Option* const paper = command
                                 ->add_option("--paper", arguments->paper,
                                              "Size of the sheets (a0 to a4) that the print is cut "
                                              "into (default: one page as large as the board)")
                                 ->type_name("SIZE")
                                 ->transform(CLI::IsMember(PaperNames(), CLI::ignore_case));
  CLI::Option* const output =
      command
          ->add_option(
              "--output", arguments->output,
              "Folder for both formats (default: this one), or a file that ends in .pdf or .svg")
          ->type_name("FILE|DIR");
  command->add_flag("--force", arguments->force, "Replace files that exist");
  AddCheckOptions(command, arguments.get())->excludes(paper)->excludes(output);
  command->callback([arguments] { RunPrint(*arguments); });
}

}  // namespace kestrel
