// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/bag_arguments.h"
#include "kestrel/app/cli/camera_file.h"
#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/progress_bar.h"
#include "kestrel/calibration/pads/pad_map.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/bags/source_calibration.h"
#include "kestrel/io/recording/euroc/calibration_output.h"
#include "kestrel/vision/tags/tag_board_detector.h"

namespace kestrel {
namespace {

struct PadsArguments {
  std::string recording;
  BagArguments bag;
  std::string camera;
  std::string family = "tag36h11";
  std::vector<int> ids;
  double size_m = 0;
  std::string output;
  bool force = false;
};

// A tag that is looked for in all images.
struct SoughtTag {
  TagBoardDetector detector;
  std::unique_ptr<TargetWorkspace> workspace;
};

TagBoard BoardOf(const PadsArguments& arguments, int id) {
  return TagTargetOptions{.family = arguments.family, .id = id, .size_m = arguments.size_m}.Board();
}

std::vector<SoughtTag> TagsOf(const PadsArguments& arguments, const CameraModel& camera) {
  std::vector<SoughtTag> tags;
  for (const int id : arguments.ids) {
    TagBoardDetector detector(camera, BoardOf(arguments, id), TagBoardDetectorOptions());
    auto workspace = detector.MakeWorkspace();
    tags.push_back({std::move(detector), std::move(workspace)});
  }
  return tags;
}

std::vector<PadSighting> Find(const cv::Mat& image, std::vector<SoughtTag>* tags) {
  std::vector<PadSighting> found;
  for (std::size_t pad = 0; pad < tags->size(); ++pad) {
    SoughtTag& tag = (*tags)[pad];
    const TargetReport report = tag.detector.Detect(image, {}, *tag.workspace);
    if (report.detection) found.push_back({pad, report.detection->camera_from_target});
  }
  return found;
}

// Images of a camera that stands say no more than one of them.
bool IsMoved(const std::vector<PadSighting>& image, const std::vector<PadSighting>& last) {
  constexpr double kMoved_m = 0.03;
  if (image.size() != last.size()) return true;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const Eigen::Vector3d way =
        image[i].camera_from_pad.translation - last[i].camera_from_pad.translation;
    if (image[i].pad != last[i].pad || way.norm() > kMoved_m) return true;
  }
  return false;
}

// Returns a board as landing.target.apriltag.board reads it.
std::string BoardText(const PadsArguments& arguments, const PadMap& map) {
  std::string text = "tags:\n";
  for (std::size_t pad = 0; pad < arguments.ids.size(); ++pad) {
    const auto& place = map.places[pad];
    if (!place) continue;
    text += fmt::format(
        "  - {{family: {}, id: {}, size_m: {:g}, x_m: {:.4f}, y_m: {:.4f}, yaw_deg: {:.3f}}}\n",
        arguments.family, arguments.ids[pad], arguments.size_m, place->position.x(),
        place->position.y(), Degrees(place->yaw));
  }
  return text;
}

void PrintResult(const PadsArguments& arguments, const PadMap& map) {
  for (std::size_t pad = 0; pad < arguments.ids.size(); ++pad) {
    const auto& place = map.places[pad];
    if (!place) {
      fmt::print(stderr,
                 "kestrel: warning: tag {} is left out: no image shows it beside a tag whose place "
                 "is known\n",
                 arguments.ids[pad]);
      continue;
    }
    fmt::print(
        stderr,
        "tag {}: {:.3f}, {:.3f} m +- {:.3f}, turned by {:.2f} +- {:.2f} degrees, in {} images\n",
        arguments.ids[pad], place->position.x(), place->position.y(), place->position_sigma_m,
        Degrees(place->yaw), Degrees(place->yaw_sigma), place->images);
  }
  fmt::print(stderr, "corners of the tags, RMS: {:.2f} px, in {} images\n", map.rms_px, map.images);
}

// A map that the images contradict would be believed by the next flight.
void RequireUse(const PadMap& map, bool force) {
  constexpr double kWorstPx = 3;
  if (map.rms_px <= kWorstPx) return;
  const std::string why = fmt::format(
      "the tags do not lie still in one plane, or size or lens are wrong: their corners are off by "
      "{:.1f} px",
      map.rms_px);
  if (!force) throw InputError(why + "; no map is written (--force writes it)");
  fmt::print(stderr, "kestrel: warning: {}\n", why);
}

void RequirePads(const PadsArguments& arguments) {
  if (arguments.ids.size() < 2) throw InputError("--ids: expected two tags or more");
  TagBoard board;
  for (const int id : arguments.ids) {
    board.tags.push_back(BoardOf(arguments, id).tags.front());
    board.tags.back().board_from_tag.translation.x() =
        2 * static_cast<double>(board.tags.size()) * arguments.size_m;
  }
  if (const auto violations = board.Validate(); !violations.empty()) {
    throw InputError(fmt::format("--family, --ids, --size: {}", fmt::join(violations, "; ")));
  }
}

std::vector<std::vector<PadSighting>> SightingsIn(FrameSource* source, const CameraIntrinsics& lens,
                                                  std::vector<SoughtTag> tags) {
  std::vector<std::vector<PadSighting>> images;
  CatchInterrupts();
  ProgressBar progress(source->frame_count());
  std::size_t done = 0;
  for (Frame frame; !WasInterrupted() && source->Next(&frame); progress.Show(++done)) {
    CheckImageSize(lens, frame.image.cols, frame.image.rows, frame.name);
    std::vector<PadSighting> found = Find(frame.image, &tags);
    if (images.empty() || IsMoved(found, images.back())) images.push_back(std::move(found));
  }
  if (WasInterrupted()) throw Interrupted("interrupted: no map is made from a part of a recording");
  return images;
}

void RunPads(const PadsArguments& arguments) {
  RequirePads(arguments);
  RequireFreeForCalibration(arguments.output, arguments.force);
  const std::unique_ptr<FrameSource> source =
      OpenFrames(arguments.bag.Recording({arguments.recording}));
  const auto calibration = CalibrationOf(*source, arguments.camera, PrintUnusedKeys);
  if (!calibration) {
    throw InputError(arguments.recording + ": has no calibration, give one by --camera FILE");
  }
  const CameraIntrinsics& lens = calibration->intrinsics;
  const auto images = SightingsIn(source.get(), lens, TagsOf(arguments, CameraModel(lens)));
  const std::vector<double> sizes(arguments.ids.size(), arguments.size_m);
  const PadMap map = EstimatePadMap(images, sizes, lens.fx_px);
  PrintResult(arguments, map);
  RequireUse(map, arguments.force);
  WriteCalibrationText(BoardText(arguments, map), arguments.output, arguments.force);
}

}  // namespace

void AddCalibratePadsCommand(CLI::App* calibrate) {
  CLI::App* command = calibrate->add_subcommand(
      "pads", "Places of tags on one floor, from images that show several of them at once");
  const auto arguments = std::make_shared<PadsArguments>();
  command
      ->add_option("RECORDING", arguments->recording,
                   "A recording folder, a bag or a folder of images of a calibrated camera")
      ->required();
  arguments->bag.AddTo(command);
  command->add_option("--camera", arguments->camera, "Calibration; overrides the recording's")
      ->type_name("FILE");
  command->add_option("--family", arguments->family, "Family of the tags (tag36h11)")
      ->type_name("NAME");
  command->add_option("--ids", arguments->ids, "The tags, as 3,7,12: the first is the origin")
      ->delimiter(',')
      ->type_name("IDS")
      ->required();
  command
      ->add_option("--size", arguments->size_m,
                   "Side of each tag, where its black and white borders meet, m")
      ->type_name("M")
      ->required();
  command
      ->add_option(
          "--output", arguments->output,
          "File for the board, as landing.target.apriltag.board reads it (default: stdout)")
      ->type_name("FILE");
  command->add_flag("--force", arguments->force,
                    "Replace a file that exists; write also a map that the images contradict");
  command->callback([arguments] { RunPads(*arguments); });
}

}  // namespace kestrel
