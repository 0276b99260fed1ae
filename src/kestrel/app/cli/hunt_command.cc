// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/commands.h"
#include "kestrel/app/cli/interrupt.h"
#include "kestrel/app/cli/recorded_run.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/cli/team_arguments.h"
#include "kestrel/app/views/hunt_view.h"
#include "kestrel/comms/team/team_link.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/session/hunt_files.h"
#include "kestrel/flight/session/hunt_run.h"
#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/flight/session/team_sharing.h"
#include "kestrel/vision/objects/color/color_grid.h"

namespace kestrel {
namespace {

constexpr double kMaxLatitude_deg = 90;

struct HuntArguments {
  SourceArguments source;
  TeamArguments team;
  std::string model;
  std::string grid;
  std::vector<double> origin;  // latitude, longitude, degrees; or empty
};

// A team shares maps, so there must be one.
void RequireMap(const OpenedSource& opened, bool is_still) {
  if (is_still) throw InputError("--team: expected a source without --still");
  if (!opened.has_world()) {
    throw InputError("--team: expected a source with poses, and the camera's mount");
  }
}

ObjectModel ReadModel(const HuntArguments& arguments) {
  return arguments.model.empty() ? DefaultObjectModel() : ReadObjectModel(arguments.model);
}

ColorGrid ReadGrid(const HuntArguments& arguments, const ObjectModel& model) {
  if (arguments.grid.empty()) return ColorGrid(model.colors);
  return ColorGrid::Load(arguments.grid, model.colors.colors.size());
}

std::unique_ptr<TeamLink> OpenTeam(const HuntArguments& arguments, const OpenedSource& opened,
                                   const KestrelOptions& options, bool is_still,
                                   const ObjectModel& model) {
  if (arguments.team.team.empty()) return nullptr;
  RequireMap(opened, is_still);
  return std::make_unique<TeamLink>(
      arguments.team.team, arguments.source.dds.Domain(), options.team, options.hunt.map, model,
      [](const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); });
}

void RunHunt(const HuntArguments& arguments) {
  const KestrelOptions all_options = arguments.source.options.Read();
  HuntPipelineOptions options = all_options.hunt;
  if (arguments.source.still) options.still = true;
  const ObjectModel model = ReadModel(arguments);
  const ColorGrid grid = ReadGrid(arguments, model);
  const OpenedSource opened = arguments.source.OpenOrAssume(PixelFormat::kBgr);
  const bool has_map = opened.has_world() && !options.still;
  std::unique_ptr<TeamLink> team = OpenTeam(arguments, opened, all_options, options.still, model);
  HuntRun hunt(opened, model, grid, options, arguments.source.altitude_m);
  const HuntPipeline& pipeline = hunt.pipeline();
  ObservationSinks sinks(SinkErrors::kThrow);
  auto files = std::make_unique<HuntFiles>(arguments.source.Output(opened), &pipeline, has_map,
                                           arguments.origin);
  AddDdsSink(arguments.source, opened, all_options, has_map, model, &sinks);
  // The team finishes after the files are written: that may be a long wait.
  TeamSharing* sharing = nullptr;
  if (team) {
    sharing =
        sinks.Add(std::make_unique<TeamSharing>(std::move(team), &pipeline.map(), arguments.origin,
                                                files->folder(), &sinks, WasInterrupted));
  }
  AddMcapSink(arguments.source, opened, HuntView{model}, &sinks);
  sinks.Add(std::move(files));
  RunToEnd(opened, &hunt, &sinks);
  if (sharing != nullptr) fmt::print(stderr, "{}\n", sharing->Found());
}

}  // namespace

void AddHuntCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("hunt", "Run the coloured-object pipeline over a source");
  const auto arguments = std::make_shared<HuntArguments>();
  arguments->source.AddTo(command);
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
  command->callback([arguments] {
    if (!arguments->origin.empty() && arguments->origin.size() != 2) {
      throw CLI::ValidationError("--origin", "expected latitude and longitude, as 50.1,14.4");
    }
    if (!arguments->origin.empty() && std::abs(arguments->origin[0]) > kMaxLatitude_deg) {
      throw CLI::ValidationError(
          "--origin", fmt::format("latitude {} is beyond {} degrees, expected latitude first",
                                  arguments->origin[0], kMaxLatitude_deg));
    }
    RunHunt(*arguments);
  });
}

}  // namespace kestrel
