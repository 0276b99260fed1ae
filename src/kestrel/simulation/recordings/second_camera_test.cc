// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/second_camera.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/recordings/test_plans.h"
#include "kestrel/simulation/vehicle/flight_time.h"
#include "kestrel/vision/pipeline/camera_state.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// A descent of 5 s over a standing vehicle, with mounts and clocks that are known. The images are
// small in number, not in size.
RecordingPlan PlanTwoCameras(std::vector<std::string> settings, std::uint64_t seed) {
  settings.insert(settings.begin(),
                  {"frames=40", "rate_hz=8", "second.rate_hz=8", "shutter.rays_per_pixel=2",
                   "navigation.mount_error_deg=0.2", "flight.start_altitude_m=14",
                   "flight.end_altitude_m=2", "ground.shadows=false", "ground.map_px=512"});
  return PlanLandingScenario("calm", settings, PaperCalibration(), seed);
}

// The calibrations of both cameras, with the true clock offsets and the nominal mounts.
std::vector<CameraCalibration> CalibrationsOf(const RecordingPlan& plan) {
  const YAML::Node scene = LoadYaml(plan.scene, "scene.yaml");
  std::vector<CameraCalibration> cameras = {
      ParseCalibration(TextOf(plan, "cam0/sensor.yaml"), "cam0"),
      ParseCalibration(TextOf(plan, "cam1/sensor.yaml"), "cam1")};
  cameras[0].clock_offset = DurationFromSeconds(scene["time_offset_s"].as<double>());
  cameras[1].clock_offset = DurationFromSeconds(scene["cam1"]["time_offset_s"].as<double>());
  return cameras;
}

using Images = std::vector<cv::Mat>;

Images Rendered(const std::vector<Time>& times, const std::function<cv::Mat(std::size_t)>& render) {
  Images images;
  for (std::size_t i = 0; i < times.size(); ++i) images.push_back(render(i));
  return images;
}
Images FirstImages(const RecordingPlan& plan) { return Rendered(plan.times, plan.render); }
Images SecondImages(const RecordingPlan& plan) {
  return Rendered(plan.further[0].times, plan.further[0].render);
}

struct SeenByBoth {
  std::vector<LandingObservation> observations;
  double largest_jump = 0;  // how far the track jumps where the camera changes, in its sigmas
  int hand_overs = 0;
  CameraState first, second;
};

// Runs the pipeline over both cameras' images in order of time.
SeenByBoth RunBoth(const RecordingPlan& plan, const std::vector<CameraCalibration>& cameras,
                   const Images& first, const Images& second) {
  LandingPipeline pipeline(cameras, {});
  std::map<Time, std::pair<std::size_t, std::size_t>> images;  // by time of the navigation
  for (std::size_t i = 0; i < plan.times.size(); ++i) {
    images[plan.times[i] + *cameras[0].clock_offset] = {0, i};
  }
  for (std::size_t i = 0; i < plan.further[0].times.size(); ++i) {
    images[plan.further[0].times[i] + *cameras[1].clock_offset] = {1, i};
  }
  for (const PoseSample& pose : ParsePoseRows(TextOf(plan, "nav0/data.csv"), "poses")) {
    pipeline.AddPose(pose);
  }
  SeenByBoth seen;
  std::optional<std::size_t> last;
  for (const auto& [time, image] : images) {
    const auto [camera, index] = image;
    const auto before = pipeline.tracker().Predict(time - *cameras[0].clock_offset);
    const LandingObservation observation =
        camera == 0 ? pipeline.Process(first[index], plan.times[index], 0)
                    : pipeline.Process(second[index], plan.further[0].times[index], 1);
    EXPECT_EQ(observation.time, time - *cameras[0].clock_offset);
    seen.observations.push_back(observation);
    if (observation.fate != MeasurementFate::kAccepted) continue;
    if (before && last && *last != camera) {
      ++seen.hand_overs;
      const double jump_m =
          (observation.target->motion.position() - before->motion.position()).norm();
      seen.largest_jump = std::max(seen.largest_jump, jump_m / before->position_sigma_m());
    }
    last = camera;
  }
  seen.first = pipeline.camera_state(0);
  seen.second = pipeline.camera_state(1);
  return seen;
}

class TwoCameras : public ::testing::TestWithParam<std::vector<std::string>> {};

TEST_P(TwoCameras, HandTheTargetOverWithoutJump) {
  const RecordingPlan plan = PlanTwoCameras(GetParam(), 1);
  const SeenByBoth seen =
      RunBoth(plan, CalibrationsOf(plan), FirstImages(plan), SecondImages(plan));
  EXPECT_GT(seen.hand_overs, 10);
  EXPECT_LT(seen.largest_jump, 2);
  EXPECT_EQ(seen.first.health, CameraHealth::kGood) << InWords(seen.first);
  EXPECT_EQ(seen.second.health, CameraHealth::kGood) << InWords(seen.second);
  EXPECT_EQ(seen.observations.back().track_state, TrackState::kTracking);
}

INSTANTIATE_TEST_SUITE_P(WideAndOther, TwoCameras,
                         ::testing::Values(std::vector<std::string>{"second.fov_deg=30"},
                                           std::vector<std::string>{"second.fov_deg=100",
                                                                    "second.tilt_deg=30"}));

// One test, as the first camera's images, which no fault of the second changes, are rendered once.
TEST(SecondCameraTest, FaultLeavesTrackToFirstCamera) {
  Images first;
  for (const auto& [fault, expected] :
       {std::pair{"dead", CameraHealth::kSilent}, std::pair{"frozen", CameraHealth::kFrozen},
        std::pair{"late", CameraHealth::kContradicts},
        std::pair{"mount", CameraHealth::kContradicts}}) {
    SCOPED_TRACE(fault);
    const RecordingPlan plan = PlanTwoCameras(
        {"second.fov_deg=40", "second.fault_at_s=2.5", std::string("second.fault=") + fault,
         "vehicle.path=straight", "vehicle.speed_mps=3"},
        3);
    if (first.empty()) first = FirstImages(plan);
    ASSERT_EQ(first.size(), plan.times.size());
    EXPECT_EQ(cv::norm(first.back(), plan.render(first.size() - 1)), 0);
    const SeenByBoth seen = RunBoth(plan, CalibrationsOf(plan), first, SecondImages(plan));
    EXPECT_EQ(seen.first.health, CameraHealth::kGood) << InWords(seen.first);
    EXPECT_EQ(seen.second.health, expected) << InWords(seen.second);
    EXPECT_EQ(seen.observations.back().track_state, TrackState::kTracking);
  }
}

// Their clocks are as far apart as those of two cameras that are opened one after the other, and
// the car passes below a UAV that keeps its place.
TEST(SecondCameraTest, IsNotLeftOutForAnUnknownClock) {
  const RecordingPlan plan =
      PlanTwoCameras({"second.fov_deg=100", "vehicle.path=straight", "vehicle.speed_mps=4"}, 3);
  const Images first = FirstImages(plan), second = SecondImages(plan);
  for (const int late_ms : {-60, 60}) {
    std::vector<CameraCalibration> cameras = CalibrationsOf(plan);
    *cameras[1].clock_offset += std::chrono::milliseconds(late_ms);
    const SeenByBoth seen = RunBoth(plan, cameras, first, second);
    EXPECT_EQ(seen.first.health, CameraHealth::kGood) << InWords(seen.first);
    EXPECT_EQ(seen.second.health, CameraHealth::kGood) << InWords(seen.second);
    EXPECT_GT(seen.hand_overs, 10);
  }
}

TEST(SecondCameraTest, HasFilesAndTruthOfItsOwn) {
  const RecordingPlan plan = PlanTwoCameras({"second.fov_deg=40"}, 1);
  ASSERT_EQ(plan.further.size(), 1u);
  EXPECT_EQ(plan.image_count(), plan.times.size() + plan.further[0].times.size());
  const auto rows = ParseImageRows(TextOf(plan, "cam1/data.csv"), "cam1");
  ASSERT_EQ(rows.size(), plan.further[0].times.size());
  EXPECT_EQ(rows[3].time, plan.further[0].times[3]);
  EXPECT_THAT(TextOf(plan, "landing_pattern0/cam1.csv"),
              HasSubstr(std::to_string(ToNanoseconds(rows[3].time))));
  const auto cameras = CalibrationsOf(plan);
  EXPECT_NE(cameras[0].clock_offset, cameras[1].clock_offset);
}

TEST(SecondCameraTest, IsRefusedWhereStillsAreShown) {
  EXPECT_THAT(InputErrorOf([] {
                PlanLandingScenario("stills", {"second.fov_deg=40"}, PaperCalibration(), 1);
              }),
              HasSubstr("second.fov_deg is more than 0"));
}

}  // namespace
}  // namespace kestrel
