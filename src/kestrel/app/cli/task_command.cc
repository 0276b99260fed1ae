// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/recorded_run.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/cli/team_arguments.h"
#include "kestrel/comms/team/team_link.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/flight/session/team_sharing.h"

namespace kestrel {
namespace {

struct TaskArguments {
  SourceArguments source;
  std::vector<double> predict_s;
  TeamArguments team;
  std::string model, grid;
  std::vector<double> origin;  // latitude, longitude, degrees; or empty
  std::vector<double> box_px;  // x, y, width, height; or empty
  std::string at = "0";        // number or name of the frame with that box

  TaskChoice Choice() const {
    TaskChoice choice{.predict_s = predict_s, .model = ReadModel(model), .origin = origin};
    if (!box_px.empty()) {
      choice.mark = {cv::Rect2d(box_px[0], box_px[1], box_px[2], box_px[3]), at};
    }
    if (!grid.empty()) choice.grid = ColorGrid::Load(grid, choice.model.colors.colors.size());
    return choice;
  }
};

void AddLandArguments(CLI::App* command, TaskArguments* arguments) {
  arguments->source.options.target.AddTo(command);
  command
      ->add_option("--predict", arguments->predict_s,
                   "Horizons (s) of predictions of the target that are written, too, as 0.5,1.0")
      ->type_name("S,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->needs("--output")
      ->check(InRange(0, 60, "seconds, above 0 and below 60"));
}

void AddHuntArguments(CLI::App* command, TaskArguments* arguments) {
  arguments->team.AddTo(command);
  command
      ->add_option("--model", arguments->model,
                   "Objects and their colours (YAML) in place of the built-in ones")
      ->type_name("FILE");
  command->add_option("--grid", arguments->grid, "Colour grid (64^3 bytes) in place of the model's")
      ->type_name("FILE");
  command
      ->add_option("--origin", arguments->origin,
                   "Latitude and longitude (degrees) of the world's origin, as 50.1,14.4: the map "
                   "is written as GeoJSON, too")
      ->type_name("LAT,LON")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(InRange(-180.0001, 180.0001, "degrees"));
}

void AddFollowArguments(CLI::App* command, TaskArguments* arguments) {
  command
      ->add_option("--box", arguments->box_px,
                   "Box around what is to be followed, in pixels, as 310,200,40,60: the pixel (X, "
                   "Y) is its upper left one")
      ->type_name("X,Y,WIDTH,HEIGHT")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->required();
  command
      ->add_option("--at", arguments->at,
                   "Frame with that box: its number, from 0, or its name as in the table")
      ->type_name("FRAME");
}

// The arguments of one task, beside those that all tasks have.
struct OwnArguments {
  std::string_view task;
  void (*add)(CLI::App* command, TaskArguments* arguments);
};
constexpr OwnArguments kOwnArguments[] = {
    {"land", AddLandArguments}, {"hunt", AddHuntArguments}, {"follow", AddFollowArguments}};

void RequireOrigin(const std::vector<double>& origin) {
  constexpr double kMaxLatitude_deg = 90;
  if (origin.empty()) return;
  if (origin.size() != 2) {
    throw CLI::ValidationError("--origin", "expected latitude and longitude, as 50.1,14.4");
  }
  if (std::abs(origin[0]) > kMaxLatitude_deg) {
    throw CLI::ValidationError(
        "--origin", fmt::format("latitude {} is beyond {} degrees, expected latitude first",
                                origin[0], kMaxLatitude_deg));
  }
}

// A team shares maps, so there must be one.
std::unique_ptr<TeamLink> OpenTeam(const TaskArguments& arguments, const OpenedSource& opened,
                                   const KestrelOptions& options, const ObjectModel& model) {
  if (arguments.team.team.empty()) return nullptr;
  if (options.hunt.still) throw InputError("--team: expected a source without --still");
  if (!opened.has_world()) {
    throw InputError("--team: expected a source with poses, and the camera's mount");
  }
  return std::make_unique<TeamLink>(
      arguments.team.team, arguments.source.dds.Domain(), options.team, options.hunt.map, model,
      [](const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); });
}

void RequireBox(const std::vector<double>& box) {
  if (box.empty() || box.size() == 4) return;
  throw CLI::ValidationError("--box", "expected x,y,width,height in pixels, as 310,200,40,60");
}

void RunTask(const TaskKind& kind, const TaskArguments& arguments) {
  RequireOrigin(arguments.origin);
  RequireBox(arguments.box_px);
  const SourceArguments& source = arguments.source;
  KestrelOptions options = source.options.Read();
  if (source.still) options.landing.still = options.hunt.still = true;
  const TaskChoice choice = arguments.Choice();
  const std::unique_ptr<Task> task = kind.make(options, choice);
  const OpenedSource opened = source.OpenOrAssume(task->format(), task->takes_several_cameras());
  opened.source->set_keeps_color(!source.annotate.empty() && task->format() == PixelFormat::kGray);
  std::unique_ptr<TeamLink> team = OpenTeam(arguments, opened, options, choice.model);
  const std::unique_ptr<Session> session = MakeSession(opened, *task, source.Session());
  const Vision& vision = session->vision();
  if (!arguments.predict_s.empty() && !vision.has_world()) {
    fmt::print(stderr,
               "no prediction: it needs a source with poses, a camera with its mount (T_BS) and no "
               "--still\n");
  }
  ObservationSinks* const sinks = &session->sinks();
  AddDdsSink(source, opened, options, *task, vision.has_world(), choice.model, sinks);
  TeamSharing* sharing = nullptr;
  if (team) {
    std::optional<OutputFolder> folder;
    if (!source.output.empty()) folder.emplace(source.output, source.force);
    sharing = sinks->Add(std::make_unique<TeamSharing>(
        std::move(team), vision.map(), arguments.origin, std::move(folder), sinks, WasInterrupted));
  }
  AddMcapSink(source, opened, *task, sinks);
  RunToEnd(opened, session.get());
  if (sharing != nullptr) fmt::print(stderr, "{}\n", sharing->Found());
}

}  // namespace

void AddTaskCommands(CLI::App* app) {
  for (const TaskKind& kind : TaskKinds()) {
    CLI::App* command = app->add_subcommand(std::string(kind.name), kind.meaning);
    const auto arguments = std::make_shared<TaskArguments>();
    arguments->source.AddTo(command);
    for (const OwnArguments& own : kOwnArguments) {
      if (own.task == kind.name) own.add(command, arguments.get());
    }
    command->callback([arguments, &kind] { RunTask(kind, *arguments); });
  }
}

}  // namespace kestrel
