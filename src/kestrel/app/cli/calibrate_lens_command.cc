// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/bag_arguments.h"
#include "kestrel/app/cli/camera_file.h"
#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/option_arguments.h"
#include "kestrel/app/cli/progress_bar.h"
#include "kestrel/app/evaluation/lens_plots.h"
#include "kestrel/calibration/lens/even_sample.h"
#include "kestrel/calibration/lens/lens_calibration.h"
#include "kestrel/core/camera/zoom_lens.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/euroc/calibration_output.h"
#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/io/recording/output_folder.h"

namespace kestrel {
namespace {

// The distortion models that the user can choose, by name.
std::map<std::string, DistortionModel> Models() {
  std::map<std::string, DistortionModel> models;
  for (const auto model : {DistortionModel::kNone, DistortionModel::kRadialTangential,
                           DistortionModel::kEquidistant}) {
    models[DistortionName(model)] = model;
  }
  return models;
}

struct LensArguments {
  std::vector<std::string> sources;
  BagArguments bag;
  std::string camera;
  std::string output;
  std::string plots;
  std::string model;
  std::string board;
  OptionArguments options;
  std::optional<double> zoom_deg;
  bool force = false;
};

// The images of the sources, and the data of their files that are not about the lens.
struct LensSources {
  std::vector<LensImage> images;
  CameraMount mount;   // as the first source has it
  double rate_hz = 0;  // as the first source has it
};

LensSources ReadSources(const std::vector<std::string>& arguments, const BagArguments& bag) {
  LensSources sources;
  for (const std::string& argument : arguments) {
    const std::unique_ptr<FrameSource> source = OpenFrames(bag.Recording({argument}));
    if (sources.rate_hz == 0) {
      sources.rate_hz = source->rate_hz();
      sources.mount = source->mount();
    }
    ProgressBar progress(source->frame_count());
    EvenSample sample;
    std::size_t frames = 0;
    for (Frame frame; !WasInterrupted() && source->Next(&frame); progress.Show(++frames)) {
      sample.Add(frame.name, frame.image);
    }
    for (LensImage& image : sample.Take()) sources.images.push_back(std::move(image));
  }
  return sources;
}

void PrintResult(const LensCalibration& lens, std::size_t images) {
  const CameraIntrinsics& camera = lens.intrinsics;
  const auto& sigmas = lens.fit.sigmas;
  fmt::print(stderr,
             "focal length: {:.2f} x {:.2f} +- {:.2f} px ({:.2g} %)\n"
             "principal point: ({:.2f}, {:.2f}) +- ({:.2f}, {:.2f}) px\n"
             "distortion: {}",
             camera.fx_px, camera.fy_px, sigmas(kFocal), 100 * sigmas(kFocal) / camera.fx_px,
             camera.cx_px, camera.cy_px, sigmas(kPrincipalX), sigmas(kPrincipalY),
             DistortionName(camera.distortion_model));
  for (int i = 0; i < lens.fit.freedom.distortion; ++i) {
    fmt::print(stderr, "{} {:.5f} +- {:.5f}", i == 0 ? ":" : ",", camera.distortion[i],
               sigmas(kDistortion + i));
  }
  fmt::print(stderr,
             "\npattern found in {} of {} images, {} views used ({} left out), residual {:.3f} px\n"
             "{}\n",
             lens.found, images, lens.views.size(), lens.outliers, lens.fit.RootMeanSquare(),
             lens.coverage.InWords());
  for (const std::string& warning : lens.warnings) {
    fmt::print(stderr, "kestrel: warning: {}\n", warning);
  }
}

void WritePlots(const LensCalibration& lens, const OutputFolder& folder) {
  for (const Plot& plot : {LensResidualPlot(lens), LensCoveragePlot(lens)}) {
    WritePlot(plot, folder.NewFile(plot.name + ".png").string());
  }
}

// Returns the lens to start from at a setting of the zoom: the file's own, scaled to this view.
CameraIntrinsics StartAt(const CameraCalibration& camera, double view_rad) {
  const CameraIntrinsics& own = camera.intrinsics;
  const auto lens = LensAt(ZoomLens{{{ViewOf(own), own}}, {}}, view_rad);
  if (!lens) throw InputError(fmt::format("--zoom-deg {:g}: no field of view", Degrees(view_rad)));
  return *lens;
}

// Replaces the setting of this view, or adds it.
void SetSetting(const ZoomLens::Setting& setting, CameraCalibration* camera) {
  constexpr double kSame = 0.01;
  if (!camera->zoom) camera->zoom.emplace();
  auto& settings = camera->zoom->settings;
  std::erase_if(settings, [&](const ZoomLens::Setting& other) {
    return std::abs(other.view_rad - setting.view_rad) <= kSame * setting.view_rad;
  });
  settings.push_back(setting);
  std::sort(settings.begin(), settings.end(),
            [](const auto& a, const auto& b) { return a.view_rad < b.view_rad; });
}

void RunLens(const LensArguments& arguments) {
  RequireFreeForCalibration(arguments.output, arguments.force);
  LensCalibrationOptions options;
  options.detector = arguments.options.Read().landing.detector;
  if (!arguments.board.empty()) options.board = ParseLensBoard(arguments.board);
  if (!arguments.model.empty()) options.model = Models().at(arguments.model);
  CameraCalibration calibration;
  if (!arguments.camera.empty()) {
    calibration = ReadCameraFile(arguments.camera);
    options.start = calibration.intrinsics;
  }
  if (arguments.zoom_deg) {
    options.model = calibration.intrinsics.distortion_model;
    options.start = StartAt(calibration, Radians(*arguments.zoom_deg));
  }
  CatchInterrupts();
  const LensSources sources = ReadSources(arguments.sources, arguments.bag);
  if (WasInterrupted()) {
    throw Interrupted("interrupted: no calibration is made from a part of the views");
  }
  if (arguments.camera.empty()) {
    calibration.body_from_camera = sources.mount.body_from_camera;
    calibration.clock_offset = sources.mount.clock_offset;
  }
  const LensCalibration lens = CalibrateLens(sources.images, options);
  PrintResult(lens, sources.images.size());
  if (arguments.zoom_deg) {
    SetSetting({Radians(*arguments.zoom_deg), lens.intrinsics}, &calibration);
  } else {
    calibration.intrinsics = lens.intrinsics;
  }
  WriteCalibration(calibration, sources.rate_hz, arguments.output, arguments.force);
  if (!arguments.plots.empty()) WritePlots(lens, OutputFolder(arguments.plots, arguments.force));
}

}  // namespace

void AddCalibrateLensCommand(CLI::App* calibrate) {
  CLI::App* command = calibrate->add_subcommand(
      "lens",
      "Focal length, principal point and distortion from views of the landing pattern, a "
      "chessboard, a ChArUco board or an AprilGrid");
  const auto arguments = std::make_shared<LensArguments>();
  command
      ->add_option("SOURCE", arguments->sources,
                   "Recording folders (EuRoC), bags, folders of images, image files or videos of "
                   "one camera, with the pattern near and far, tilted, and all over the image")
      ->required();
  arguments->bag.AddTo(command);
  command
      ->add_option("--camera", arguments->camera,
                   "Calibration to start from (default: several guesses are tried)")
      ->type_name("FILE");
  CLI::Option* const camera = command->get_option("--camera");
  command
      ->add_option("--zoom-deg", arguments->zoom_deg,
                   "The result is a setting of a camera that zooms, beside those in the file of "
                   "--camera: the horizontal field of view that the camera reports there")
      ->type_name("DEG")
      ->needs(camera);
  command
      ->add_option("--model", arguments->model,
                   "Distortion model (default: the one that fits the views best)")
      ->type_name("NAME")
      ->check(CLI::IsMember(Models()));
  command
      ->add_option("--board", arguments->board,
                   "In place of the landing pattern: chessboard:9x6:0.025 (inner corners, square), "
                   "charuco:7x5:0.04:0.03 (squares, square, marker; :DICT_5X5_100), "
                   "aprilgrid:6x6:0.088:0.3 (tags, tag, gap over tag); lengths in m")
      ->type_name("BOARD");
  arguments->options.AddTo(command);
  command
      ->add_option("--output", arguments->output,
                   "File for the calibration, as --camera reads it (default: stdout)")
      ->type_name("FILE");
  command
      ->add_option("--plots", arguments->plots,
                   "Folder for lens_residuals.png and lens_coverage.png")
      ->type_name("DIR");
  command->add_flag("--force", arguments->force, "Replace files that exist");
  command->callback([arguments] { RunLens(*arguments); });
}

}  // namespace kestrel
