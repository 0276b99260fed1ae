// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/hunt_command.h"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/ground_warning.h"
#include "kestrel/app/cli/hunt_sink.h"
#include "kestrel/app/cli/pipeline_run.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/app/cli/team_link.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

struct HuntArguments {
  SourceArguments source;
  TeamArguments team;
  std::string model;
  std::string grid;
  std::vector<double> origin;  // latitude, longitude, degrees; or empty
};

class HuntRun : public PipelineRun {
 public:
  HuntRun(const OpenedSource& opened, const ObjectModel& model, const ColorGrid& grid,
          const HuntPipelineOptions& options, const HuntArguments& arguments, TeamLink* team,
          RosResults* dds)
      : pipeline_(opened.calibration, model, grid, options),
        mcap_(arguments.source.OpenMcap(opened.calibration.intrinsics, HuntView{model})),
        sink_(arguments.source.Output(opened), arguments.origin),
        has_map_(opened.has_world() && !options.still),
        team_(team),
        dds_(dds),
        altitude_m_(arguments.source.altitude_m) {
    pipeline_.SetAltitude(altitude_m_);
  }

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }

  // Time from the middle row to the last row of a rolling shutter.
  Duration after_frame() const override {
    return DurationFromSeconds(pipeline_.options().readout_s / 2);
  }

  Duration Process(const Frame& frame) override {
    const HuntObservation& observation = pipeline_.Process(frame.image, frame.time);
    sink_.Write(frame, observation, pipeline_);
    if (mcap_) mcap_->Write(frame, observation);
    if (dds_ != nullptr) dds_->Publish(frame, observation);
    detections_ += observation.report.detections.size();
    for (std::size_t i = 0; i < kObjectStageCount; ++i) passed_[i] += observation.report.passed[i];
    has_world_ = observation.world_from_camera.has_value();
    if (team_ != nullptr) ShareMap(observation);
    return observation.detect_time;
  }

  std::string Warning() const override { return GroundWarning(pipeline_, altitude_m_, has_world_); }

  void Finish() override {
    if (has_map_) sink_.WriteMap(pipeline_);
    if (mcap_) mcap_->Close();
    if (team_ != nullptr) LeaveTeam();
    if (dds_ != nullptr) dds_->Flush();
  }

  std::string Found() const override { return fmt::format("{} detections", detections_); }

  // Number of segments left after each step, as in the paper's Table 3.
  std::string Remarks() const override {
    std::string remarks = "segments";
    for (std::size_t i = 0; i < kObjectStageCount; ++i) {
      remarks += fmt::format("{} {} {}", i == 0 ? "" : ",", passed_[i],
                             ToString(static_cast<ObjectStage>(i)));
    }
    if (team_ != nullptr) remarks += "\n" + team_->Found();
    return remarks + "\n";
  }

 private:
  void ShareMap(const HuntObservation& observation) {
    if (observation.world_from_camera) {
      team_->SetPosition(observation.world_from_camera->translation);
    }
    seen_ = observation.time;
    if (team_->IsTimeToTell()) {
      team_->Tell(pipeline_.map().Confirmed());
      PublishTeam();
    }
    team_->Exchange();
  }

  void LeaveTeam() {
    team_->Finish(pipeline_.map().Confirmed());
    PublishTeam();
    sink_.WriteTeamMap(team_);
  }

  void PublishTeam() {
    if (dds_ != nullptr) dds_->Publish(TeamReport{seen_, team_->Map()});
  }

  HuntPipeline pipeline_;
  std::unique_ptr<ObservationFile> mcap_;
  HuntSink sink_;
  bool has_map_;
  TeamLink* team_;   // null: none
  RosResults* dds_;  // null: none
  std::optional<double> altitude_m_;
  bool has_world_ = false;  // the last frame had a pose
  Time seen_{};             // time of the last frame
  std::size_t detections_ = 0;
  std::array<std::size_t, kObjectStageCount> passed_{};
};

// A team shares maps, so there must be one.
void RequireMap(const OpenedSource& opened, const HuntPipelineOptions& options) {
  if (options.still) throw InputError("--team: expected a source that is no --still");
  if (!opened.has_world()) {
    throw InputError("--team: expected a source with poses, and the camera's mount");
  }
}

void RunHunt(const HuntArguments& arguments) {
  const KestrelOptions all_options = arguments.source.options.Read();
  HuntPipelineOptions options = all_options.hunt;
  if (arguments.source.still) options.still = true;
  const ObjectModel model =
      arguments.model.empty() ? DefaultObjectModel() : ReadObjectModel(arguments.model);
  const ColorGrid grid = arguments.grid.empty()
                             ? ColorGrid(model.colors)
                             : ColorGrid::Load(arguments.grid, model.colors.colors.size());
  const OpenedSource opened = arguments.source.Open(PixelFormat::kBgr);
  std::optional<TeamLink> team;
  if (!arguments.team.team.empty()) {
    RequireMap(opened, options);
    team.emplace(arguments.team, arguments.source.dds.Domain(), all_options.team, options.map,
                 model, [](const std::string& text) { fmt::print(stderr, "kestrel: {}\n", text); });
  }
  const std::unique_ptr<RosResults> dds = OpenRosResults(arguments.source, opened, all_options,
                                                         /*is_still=*/options.still, model);
  HuntRun run(opened, model, grid, options, arguments, team ? &*team : nullptr, dds.get());
  RunPipeline(opened, &run);
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
  command
      ->add_option("--grid", arguments->grid,
                   "Color grid (64^3 bytes) in place of the one that the model gives")
      ->type_name("FILE");
  command
      ->add_option("--origin", arguments->origin,
                   "Latitude and longitude (degrees) of the world's origin, as 50.1,14.4: also "
                   "write the map as GeoJSON")
      ->type_name("LAT,LON")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(InRange(-180.0001, 180.0001, "degrees"));
  command->callback([arguments] {
    if (!arguments->origin.empty() && arguments->origin.size() != 2) {
      throw CLI::ValidationError("--origin", "expected latitude and longitude, as 50.1,14.4");
    }
    RunHunt(*arguments);
  });
}

}  // namespace kestrel
