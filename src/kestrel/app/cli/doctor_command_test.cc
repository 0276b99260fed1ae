// SPDX-License-Identifier: BSD-3-Clause
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/euroc/euroc_text.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class DoctorCommandTest : public CommandTest {
 protected:
  // A UAV in the air beside the pattern that nobody lands; renders quickly.
  static constexpr const char* kHover =
      " --duration 5 --set fly.sim_autopilot.pilot.start_altitude_m=2.5"
      " --set fly.sim_autopilot.pilot.land_after_s=-1"
      " --set fly.sim_autopilot.pilot.offset_east_m=0.3"
      " --set fly.sim_autopilot.pilot.offset_north_m=-0.3";

  Outcome Look(const std::string& arguments, const std::string& input = "") const {
    return Run("doctor sim:standing" + std::string(kHover) + " " + arguments, input);
  }

  // Names of the checks with this verdict in a result of --json. Checks that depend on how busy
  // this computer is are left out.
  static std::vector<std::string> Checks(const Outcome& outcome, const std::string& verdict) {
    static const std::set<std::string> kOfTime = {
        "frame rate", "steadiness", "missed images", "detection time",    "load",      "heat",
        "power",      "latency",    "attitude",      "autopilot's clock", "round trip"};
    std::vector<std::string> checks;
    const nlohmann::json json = nlohmann::json::parse(outcome.out);
    for (const auto& finding : json["findings"]) {
      const std::string check = finding["check"];
      if (finding["verdict"] == verdict && !kOfTime.contains(check)) checks.push_back(check);
    }
    return checks;
  }
};

TEST_F(DoctorCommandTest, PassesGoodSetup) {
  for (const std::string firmware : {"ardupilot", "px4"}) {
    const Outcome outcome = Look("--json --autopilot sim:" + firmware);
    EXPECT_THAT(Checks(outcome, "wrong"), IsEmpty()) << outcome.out;
    EXPECT_THAT(Checks(outcome, "doubtful"), IsEmpty()) << outcome.out;
    EXPECT_THAT(Checks(outcome, "good"),
                AllOf(Contains("image size"), Contains("focus"), Contains("exposure"),
                      Contains("calibration by the pattern"), Contains("mount against gravity"),
                      Contains("mount against motion"), Contains("heartbeat")))
        << outcome.out;
  }
}

TEST_F(DoctorCommandTest, ReportsParameterFaults) {
  const Outcome ardupilot = Look(
      "--json --guide --moving --autopilot sim:ardupilot"
      " --set fly.sim_autopilot.parameters=PLND_TYPE=0,GUID_TIMEOUT=5");
  EXPECT_EQ(ardupilot.status, 1);
  EXPECT_THAT(ardupilot.err, HasSubstr("kestrel: wrong: "));
  EXPECT_THAT(Checks(ardupilot, "wrong"), Contains("GUID_TIMEOUT")) << ardupilot.out;
  EXPECT_THAT(Checks(ardupilot, "doubtful"),
              AllOf(Contains("PLND_TYPE"), Contains("PLND_OPTIONS"), Contains("PLND_RET_MAX")))
      << "set-points land without targets";
  const Outcome px4 = Look(
      "--json --guide --moving --autopilot sim:px4"
      " --set fly.sim_autopilot.parameters=COM_OF_LOSS_T=5,COM_OBL_RC_ACT=0,NAV_RCL_ACT=0");
  EXPECT_EQ(px4.status, 1);
  EXPECT_THAT(Checks(px4, "wrong"), AllOf(Contains("COM_OF_LOSS_T"), Contains("COM_OBL_RC_ACT"),
                                          Contains("LNDMC_XY_VEL_MAX")))
      << px4.out;
}

TEST_F(DoctorCommandTest, ReportsCalibrationOfAnotherSizeOrLens) {
  const auto camera = [&](int width, int height, double focal) {
    return folder_.Write("camera.yaml",
                         fmt::format("camera_model: pinhole\n"
                                     "intrinsics: [{0}, {0}, {1}, {2}]\n"
                                     "resolution: [{3}, {4}]\n"
                                     "distortion_model: equidistant\n"
                                     "distortion_coefficients: [0, 0, 0, 0]\n",
                                     focal, (width - 1) / 2.0, (height - 1) / 2.0, width, height));
  };
  const Outcome swapped = Look("--json --autopilot sim:ardupilot --camera " + camera(240, 376, 90));
  EXPECT_EQ(swapped.status, 1);
  EXPECT_THAT(Checks(swapped, "wrong"), Contains("image size")) << swapped.out;
  EXPECT_THAT(swapped.out, HasSubstr("swapped"));
  const Outcome other = Look("--json --autopilot sim:ardupilot --camera " + camera(376, 240, 200));
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(Checks(other, "wrong"), Contains("calibration by the pattern")) << other.out;
}

TEST_F(DoctorCommandTest, ReportsRotatedMount) {
  CameraCalibration calibration;
  // The simulated camera: half of the paper's.
  calibration.intrinsics = PaperCamera();
  calibration.intrinsics.width_px = 376;
  calibration.intrinsics.height_px = 240;
  calibration.intrinsics.fx_px = calibration.intrinsics.fy_px = 130.5;
  calibration.intrinsics.cx_px = 187.75;
  calibration.intrinsics.cy_px = 119.75;
  // The image's upper edge points ahead of the UAV; the calibration says: to the right.
  calibration.body_from_camera.emplace();
  calibration.body_from_camera->rotation = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX());
  const std::string camera =
      folder_.Write("turned.yaml", EurocCameraText(calibration, /*rate_hz=*/20));
  const Outcome outcome = Look("--json --autopilot sim:ardupilot --camera " + camera +
                               " --set fly.sim_autopilot.uav.wind.min_mps=5"
                               " --set fly.sim_autopilot.uav.wind.max_mps=7");
  EXPECT_THAT(Checks(outcome, "wrong"), Contains("mount against motion")) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("turned by 90 deg"));
}

TEST_F(DoctorCommandTest, ReportsCameraThatSeesPadAtAnotherTime) {
  const Outcome outcome = Look(
      "--json --autopilot sim:ardupilot --set fly.sim_autopilot.uav.wind.min_mps=5"
      " --set fly.sim_autopilot.uav.wind.max_mps=7 --set fly.sim_camera.second.fov_deg=100"
      " --set fly.sim_camera.second.clock_offset_s=-0.15");
  EXPECT_THAT(Checks(outcome, "wrong"), Contains("cam1: beside the first camera")) << outcome.out;
  EXPECT_THAT(Checks(outcome, "good"), Contains("cam1: image size")) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("at different times"));
}

TEST_F(DoctorCommandTest, ReportsUnavailableCameraAndAutopilot) {
  const Outcome outcome =
      Run("doctor /dev/no_such_camera --camera " + folder_.Write("camera.yaml", "") +
          " --autopilot serial:///dev/no_such_line:57600 --duration 1");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("images"), HasSubstr("/dev/no_such_line")));
  EXPECT_THAT(Run("doctor sim:standing --duration 1 --autopilot udpin://127.0.0.1:0").out,
              HasSubstr("wrong"));
}

TEST_F(DoctorCommandTest, AppliesFixesTheUserConfirms) {
  const std::string broken =
      "--fix --autopilot sim:ardupilot"
      " --set fly.sim_autopilot.parameters=PLND_TYPE=2,PLND_YAW_ALIGN=9000"
      " --set fly.sim_autopilot.pilot.start_altitude_m=0";
  const Outcome agreed = Look(broken, "y\ny\ny\n");
  EXPECT_THAT(agreed.err, AllOf(HasSubstr("PLND_TYPE is 2. Set it to 1? (y/n)"),
                                HasSubstr("PLND_TYPE: written, now 1"),
                                HasSubstr("PLND_YAW_ALIGN: written, now 0"), HasSubstr("restart")));
  EXPECT_THAT(agreed.err, Not(HasSubstr("wrong: PLND"))) << agreed.err;
  const Outcome refused = Look(broken, "n\nn\nn\n");
  EXPECT_THAT(refused.err, Not(HasSubstr("written")));
  EXPECT_EQ(refused.status, 1);
}

TEST_F(DoctorCommandTest, ExplainsWithoutCameraAndAutopilot) {
  const Outcome outcome = Succeed("doctor --explain");
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("ArduPilot thinks: 10.13 north, 22.23 east"),
                                 HasSubstr("PX4 (VTE_EN 0) thinks: 10.13 north, 22.23 east"),
                                 HasSubstr("PLD_SRCH_ALT "), HasSubstr("time of day ")));
  EXPECT_EQ(Run("doctor").status, 2);
  EXPECT_EQ(Run("doctor sim:standing --explain --json").status, 2);
}

}  // namespace
}  // namespace kestrel
