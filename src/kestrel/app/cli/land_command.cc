// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/land_command.h"

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "kestrel/app/cli/landing_sink.h"
#include "kestrel/app/cli/pipeline_run.h"
#include "kestrel/app/cli/source_arguments.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/pipeline/calibration_monitor.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"
#include "kestrel/vision/pipeline/told_contradictions.h"

namespace kestrel {
namespace {

struct LandArguments {
  SourceArguments source;
  std::vector<double> predict_s;
};

// Returns how the detections contradict the given height and attitude; empty where they do not.
std::string ToldWarning(const LandingPipeline& pipeline, std::optional<double> altitude_m,
                        bool has_world) {
  if (const auto tilt = pipeline.contradictions().Attitude()) {
    return fmt::format(
        "the attitude says that the pattern is tilted by {:.0f} degrees (median of {} frames): {}"
        "check the mount (kestrel calibrate mount) and the navigation's attitude",
        Degrees(tilt->difference), tilt->detections,
        tilt->difference > kPi / 2 ? "is the camera mounted upside down? " : "");
  }
  const auto excess = pipeline.contradictions().Altitude();
  if (!excess) return "";
  const std::string what = fmt::format(
      "the altitude told is {:.1f} m {} what the pattern shows (median of {} frames, standard "
      "deviation {:.1f} m): ",
      std::abs(excess->difference), excess->difference > 0 ? "above" : "below", excess->detections,
      excess->sigma);
  if (has_world) {
    return fmt::format(
        "{}set landing.target_height_m={:.1f}, or correct the navigation's z or the pattern's size",
        what, pipeline.options().target_height_m + excess->difference);
  }
  return fmt::format("{}set --altitude {:.1f}, or correct the pattern's size", what,
                     altitude_m.value_or(0) - excess->difference);
}

class LandRun : public PipelineRun {
 public:
  LandRun(const OpenedSource& opened, const LandingPipelineOptions& options,
          const LandArguments& arguments, bool has_track, RosResults* dds)
      : pipeline_(opened.calibration, options),
        mcap_(arguments.source.OpenMcap(opened.calibration.intrinsics,
                                        ViewOf(opened.calibration, options))),
        sink_(arguments.source.Output(opened), has_track, arguments.predict_s),
        dds_(dds),
        altitude_m_(arguments.source.altitude_m),
        has_world_(opened.has_world()) {
    pipeline_.SetAltitude(altitude_m_);
  }

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }

  Duration Process(const Frame& frame) override {
    const LandingObservation observation = pipeline_.Process(frame.image, frame.time);
    sink_.Write(frame, observation, pipeline_);
    if (mcap_) mcap_->Write(frame, observation);
    if (dds_ != nullptr) dds_->Publish(frame, observation);
    ++poses_[observation.pose];
    found_ += observation.report.detection.has_value();
    return observation.detect_time;
  }

  std::string Warning() const override { return ToldWarning(pipeline_, altitude_m_, has_world_); }

  void Finish() override {
    if (mcap_) mcap_->Close();
    if (dds_ != nullptr) dds_->Flush();
  }

  std::string Found() const override { return fmt::format("pattern found in {}", found_); }

  std::string Remarks() const override {
    const double focal_px = pipeline_.detector().camera().intrinsics().fx_px;
    std::string remarks = LensWarning(pipeline_.calibration_monitor(), focal_px);
    if (!remarks.empty()) remarks += "\n";
    // Only where there are poses for some of the frames; a source without any is not unusual.
    for (const auto& [pose, count] : poses_) {
      if (pose == PoseLookup::kFound || pose == PoseLookup::kEmpty ||
          pose == PoseLookup::kPredicted) {
        continue;
      }
      remarks += fmt::format("{} frames without a pose of the UAV: {}\n", count, ToString(pose));
    }
    return remarks;
  }

 private:
  LandingPipeline pipeline_;
  std::unique_ptr<ObservationFile> mcap_;
  LandingSink sink_;
  RosResults* dds_;  // null: none
  std::optional<double> altitude_m_;
  bool has_world_;
  std::map<PoseLookup, std::size_t> poses_;
  std::size_t found_ = 0;
};

void RunLand(const LandArguments& arguments) {
  const KestrelOptions all_options = arguments.source.options.Read();
  LandingPipelineOptions options = all_options.landing;
  if (arguments.source.still) options.still = true;
  const OpenedSource opened = arguments.source.Open(PixelFormat::kGray);
  const bool has_track = opened.has_world() && !options.still;
  if (!arguments.predict_s.empty() && !has_track) {
    fmt::print(stderr,
               "no prediction: it needs a source with poses, a camera with its mount (T_BS) and no "
               "--still\n");
  }
  const std::unique_ptr<RosResults> dds =
      OpenRosResults(arguments.source, opened, all_options, options.still, /*model=*/{});
  LandRun run(opened, options, arguments, has_track, dds.get());
  RunPipeline(opened, &run);
}

}  // namespace

void AddLandCommand(CLI::App* app) {
  CLI::App* command = app->add_subcommand("land", "Run the landing pipeline over a source");
  const auto arguments = std::make_shared<LandArguments>();
  arguments->source.AddTo(command);
  command
      ->add_option("--predict", arguments->predict_s,
                   "Also write where the target will be after these times (s), as 0.5,1.0")
      ->type_name("S,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->needs("--output")
      ->check(InRange(0, 60, "seconds, above 0 and below 60"));
  command->callback([arguments] { RunLand(*arguments); });
}

}  // namespace kestrel
