// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/calibration/color_training/color_teaching.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/write_file.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/color_marks.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/io/recording/overlays/color_pictures.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {
namespace {

struct ColorsArguments {
  std::string marks;
  std::string model;
  std::string output;
  int components = 2;
  bool force = false;
};

void WritePicture(const OutputFolder& folder, const std::string& name, const cv::Mat& picture) {
  WriteImage(folder.NewFile(name).string(), picture);
}

void RunColors(const ColorsArguments& arguments) {
  const std::vector<ColorMark> marks = ParseColorMarks(ReadFile(arguments.marks), arguments.marks);
  ObjectModel model =
      arguments.model.empty() ? DefaultObjectModel() : ReadObjectModel(arguments.model);
  for (const std::string& line :
       ReplaceColors(ReadMarkedColors(marks), arguments.components, &model)) {
    fmt::print(stderr, "{}\n", line);
  }
  const ColorGrid grid(model.colors);
  const OutputFolder folder(arguments.output, arguments.force);
  WriteFile(folder.NewFile("objects.yaml").string(), PrintObjectModel(model));
  grid.Save(folder.NewFile("colors.grid").string());
  WritePicture(folder, "hue_saturation.png", DrawHueSaturation(grid));
  std::set<std::string> images;
  for (const ColorMark& mark : marks) images.insert(mark.image);
  int count = 0;
  for (const std::string& image : images) {
    WritePicture(folder, fmt::format("labels_{:02}.png", ++count),
                 DrawLabels(ReadImage(image, PixelFormat::kBgr), grid));
  }
}

}  // namespace

void AddCalibrateColorsCommand(CLI::App* calibrate) {
  CLI::App* command =
      calibrate->add_subcommand("colors", "Colour models from images with marked pixels");
  const auto arguments = std::make_shared<ColorsArguments>();
  command
      ->add_option("MARKS", arguments->marks,
                   "YAML list of {image: FILE, color: NAME, rectangle: [x, y, width, height]} or "
                   "{image: FILE, color: NAME, mask: FILE}")
      ->required();
  command
      ->add_option("--model", arguments->model,
                   "Objects whose colours are fitted, in place of the built-in ones")
      ->type_name("FILE");
  command
      ->add_option("--output", arguments->output,
                   "Folder for objects.yaml, colors.grid and the pictures")
      ->type_name("DIR")
      ->required();
  command
      ->add_option(
          "--components", arguments->components,
          "Largest number of Gaussians of a colour; the Bayesian information criterion chooses")
      ->type_name("N")
      ->check(CLI::Range(1, 8));
  command->add_flag("--force", arguments->force, "Replace files that exist");
  command->callback([arguments] { RunColors(*arguments); });
}

}  // namespace kestrel
