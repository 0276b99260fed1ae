// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/camera_file.h"
#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/option_arguments.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/calibration/print/pattern_print.h"
#include "kestrel/calibration/print/print_check.h"
#include "kestrel/calibration/print/print_measurement.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {
namespace {

constexpr char kPdf[] = ".pdf", kSvg[] = ".svg";
// Sizes of the pads of --starter: one sheet, for the bench and the last metres; and one for
// flights.
constexpr double kNear_m = 0.16, kFar_m = 0.5;

struct PrintArguments {
  OptionArguments options;
  std::string paper;
  std::string output = ".";
  bool starter = false;
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

// Writes the SVGs, of one page each: to a folder where there are several.
void PrintTiled(const TiledPrint& pad, const std::string& name, const std::string& kind,
                const PrintFiles& files) {
  const TargetPrint& print = pad.print;
  const Tiling& tiling = pad.tiling;
  if (kind != kSvg) {
    const std::string path =
        files.Add(name + kPdf, [&](const std::string& file) { PrintTilesPdf({pad}, file); });
    fmt::print(stderr, "{}: {}\n", path, SheetsInWords(print, tiling));
  }
  if (kind == kPdf) return;
  if (tiling.count() == 1) {
    const std::string path =
        files.Add(name + kSvg, [&](const std::string& file) { PrintTileSvg(pad, 0, 0, file); });
    fmt::print(stderr, "{}\n", path);
    return;
  }
  const std::string overview = files.Add(
      name + "/overview" + kSvg, [&](const std::string& file) { PrintOverviewSvg(pad, file); });
  for (int row = 0; row < tiling.rows; ++row) {
    for (int column = 0; column < tiling.columns; ++column) {
      if (!HasPrint(print, tiling, row, column)) continue;
      files.Add(fmt::format("{}/sheet_{}.{}{}", name, row + 1, column + 1, kSvg),
                [&](const std::string& file) { PrintTileSvg(pad, row, column, file); });
    }
  }
  fmt::print(stderr, "{}, and its sheets beside it\n", overview);
}

PrintMeasurement Measure(const PrintArguments& arguments,
                         const LandingPatternDetectorOptions& detector) {
  const cv::Mat photo = ReadGrayImage(arguments.photo);
  std::optional<CameraIntrinsics> camera;
  if (!arguments.camera.empty()) {
    camera = ReadCameraFile(arguments.camera).intrinsics;
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
  const LandingPipelineOptions landing = arguments.options.Read().landing;
  const LandingPatternDetectorOptions detector = RingOfTarget(landing.target, landing.detector);
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

TargetPrint ConfiguredPrint(const OptionArguments& options) {
  const LandingPipelineOptions landing = options.Read().landing;
  return PrintOfTarget(landing.target, landing.detector.pattern);
}

// Returns how the other commands are told of a pad that was scaled; empty for one that was not.
std::string FlyWith(const TargetArguments& target) {
  if (!target.size_m) return "";
  std::string words = "Fly with it: kestrel fly ...";
  if (!target.kind.empty()) words += " --target " + target.kind;
  if (target.id) words += fmt::format(" --target-id {}", *target.id);
  return words + fmt::format(" --target-size {}", *target.size_m);
}

// One sheet where the print fits, otherwise as many as the board needs.
Tiling SheetsFor(const TargetPrint& print, const std::string& paper) {
  const Eigen::Vector2d size = *PaperSize(paper);
  const std::optional<Tiling> sheet = OneSheet(print.board_size_m, InkSize(print), size);
  return sheet ? *sheet : TileBoard(print.board_size_m, size);
}

// Returns the name of the smallest paper, one sheet of which the print fits; empty beyond all.
std::string SmallestPaper(const TargetPrint& print) {
  std::string smallest;
  for (const std::string& name : PaperNames()) {  // largest first
    if (OneSheet(print.board_size_m, InkSize(print), *PaperSize(name))) smallest = name;
  }
  return smallest;
}

void PrintStarter(const PrintArguments& arguments, const std::string& name,
                  const PrintFiles& files) {
  const std::string paper = arguments.paper.empty() ? "a4" : arguments.paper;
  std::vector<TiledPrint> pads;
  for (const double size_m : {kNear_m, kFar_m}) {
    OptionArguments options = arguments.options;
    options.target.size_m = size_m;
    const TargetPrint print = ConfiguredPrint(options);
    pads.push_back({print, SheetsFor(print, paper), FlyWith(options.target)});
  }
  const std::string path =
      files.Add(name + kPdf, [&](const std::string& file) { PrintTilesPdf(pads, file); });
  fmt::print(stderr, "{}: a near and a far pad on {}\n", path, paper);
  for (const TiledPrint& pad : pads) {
    fmt::print(stderr, "{}. {}\n", SheetsInWords(pad.print, pad.tiling), pad.note);
  }
}

void RunPrint(const PrintArguments& arguments) {
  if (!arguments.photo.empty()) {
    CheckPhoto(arguments);
    return;
  }
  const TargetPrint print = ConfiguredPrint(arguments.options);
  const std::filesystem::path output(arguments.output);
  const std::string kind = output.extension().string();
  const bool is_file = kind == kPdf || kind == kSvg;
  if (!is_file && !kind.empty() && !std::filesystem::is_directory(output)) {
    throw InputError(
        arguments.output +
        ": expected a name that ends in .pdf or .svg, or a folder's without an ending");
  }
  const PrintFiles files(is_file ? output.parent_path() / "." : output, arguments.force);
  if (arguments.starter) {
    if (kind == kSvg) throw InputError(arguments.output + ": --starter is a PDF");
    PrintStarter(arguments, is_file ? output.stem().string() : "landing_starter", files);
    return;
  }
  const std::string note = FlyWith(arguments.options.target);
  const std::string paper =
      arguments.paper.empty() && !note.empty() ? SmallestPaper(print) : arguments.paper;
  if (paper.empty()) {
    const std::string name = is_file ? output.stem().string() : "landing_pattern";
    PrintWhole(print, name, is_file ? kind : "", files);
  } else {
    const std::string name = is_file ? output.stem().string() : "landing_pattern_" + paper;
    PrintTiled({print, SheetsFor(print, paper), note}, name, is_file ? kind : "", files);
    fmt::print(stderr, "Print it on {} at 100 %.\n", paper);
  }
  if (!note.empty()) fmt::print(stderr, "{}\n", note);
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
  arguments->options.target.AddTo(command, "--size,--target-size");
  CLI::Option* const paper = command
                                 ->add_option("--paper", arguments->paper,
                                              "Size of the sheets (a0 to a4) that the print is cut "
                                              "into (default: one page as large as the board; "
                                              "with --size the smallest sheet that it fits on)")
                                 ->type_name("SIZE")
                                 ->transform(CLI::IsMember(PaperNames(), CLI::ignore_case));
  CLI::Option* const output =
      command
          ->add_option(
              "--output", arguments->output,
              "Folder for both formats (default: this one), or a file that ends in .pdf or .svg")
          ->type_name("FILE|DIR");
  CLI::Option* const starter = command->add_flag(
      "--starter", arguments->starter,
      "A near pad (0.16 m) and a far one (0.5 m) as one PDF, on --paper (default: a4)");
  starter->excludes("--size");
  command->add_flag("--force", arguments->force, "Replace files that exist");
  AddCheckOptions(command, arguments.get())->excludes(paper)->excludes(output)->excludes(starter);
  command->callback([arguments] { RunPrint(*arguments); });
}

}  // namespace kestrel
