// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/stills_simulation.h"

#include <memory>

#include <fmt/format.h>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/options.h"
#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "kestrel/simulation/recordings/truth_text.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

constexpr double kRate_hz = 1;

std::string SceneText(const StillsOptions& options, const LandingPattern& pattern, int frames,
                      double lens_half_angle_deg, const CameraCalibration& camera,
                      std::uint64_t seed) {
  return fmt::format(
             "kind: landing stills\nseed: {}\nframes: {}\nlens_half_angle_deg: {}\n"
             "image_timestamp: middle of the exposure\ntime_offset_s: 0\n"
             "mount_error:\n  yaw_deg: 0\n  pitch_deg: 0\n  roll_deg: 0\n",
             seed, frames, lens_half_angle_deg) +
         "stills:\n" + Indented(PrintOptions(options)) + "pattern:\n" +
         Indented(PrintOptions(pattern)) + "camera:\n" +
         Indented(EurocCameraText(camera, kRate_hz));
}

std::string TruthRow(Time time, const LandingStill& still) {
  return fmt::format("{},0,0,0,1,0,0,0,0,0,0,{:.4f},{:.4f},{:.6f},{:.4f}\n", ToNanoseconds(time),
                     still.center_px.x(), still.center_px.y(), still.altitude_m,
                     still.visible_fraction);
}

}  // namespace

std::vector<std::string> StillsOptions::Validate() const {
  std::vector<std::string> violations;
  Require(max_altitude_m, Range{min_altitude_m, 100}, "max_altitude_m", &violations);
  return violations;
}

RecordingPlan PlanStills(const StillsOptions& options, const LandingPattern& pattern, int frames,
                         double lens_half_angle_deg, const CameraCalibration& camera,
                         std::uint64_t seed) {
  RequireValid(options);
  const bool lookalikes = options.show == "lookalikes";
  LandingStillOptions still_options;
  still_options.camera = camera.intrinsics;
  still_options.lens_half_angle_deg = lens_half_angle_deg;
  still_options.pattern = pattern;
  still_options.min_altitude_m = options.min_altitude_m;
  still_options.max_altitude_m = options.max_altitude_m;
  still_options.max_tilt_deg = options.max_tilt_deg;
  still_options.min_visible_fraction = options.min_visible_fraction;
  const auto maker = std::make_shared<LandingStillMaker>(still_options);

  RecordingPlan plan;
  std::vector<PoseSample> poses;
  std::string truth = LandingTruthHeader();
  const RigidTransform camera_from_body = camera.body_from_camera->Inverse();
  for (int i = 0; i < frames; ++i) {
    const Time time = TimeOfFlight(i / kRate_hz);
    plan.times.push_back(time);
    RigidTransform camera_from_world;
    if (lookalikes) {
      camera_from_world = maker->PlaceLookalikes(Hash(seed, i)).camera_from_target;
    } else {
      const LandingStill still = maker->PlacePattern(Hash(seed, i));
      camera_from_world = still.camera_from_target;
      truth += TruthRow(time, still);
    }
    poses.push_back({time, camera_from_world.Inverse() * camera_from_body});
  }
  plan.render = [=](std::size_t i) {
    return lookalikes ? maker->MakeLookalikes(Hash(seed, i)).image
                      : maker->MakePattern(Hash(seed, i)).image;
  };
  plan.scene = SceneText(options, pattern, frames, lens_half_angle_deg, camera, seed);
  plan.files = {{euroc::kCamera, EurocCameraText(camera, kRate_hz)},
                {euroc::kPoseSensor, EurocPoseSensorText(kRate_hz)},
                {euroc::kPoses, EurocPoseText(poses)},
                {euroc::kTruePoses, TrueStateText(poses)},
                {euroc::kTruePatterns, truth}};
  return plan;
}

}  // namespace kestrel
