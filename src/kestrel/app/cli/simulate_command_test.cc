// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <regex>
#include <string>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/core/codec/image_codec.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class SimulateCommandTest : public CommandTest {
 protected:
  // The columns of landing_detections.csv in the camera's frame, up to p_CP_C_z_m. Poses are
  // rounded in the files, and with them the positions in the world.
  static std::string InCamera(const std::string& csv) {
    return std::regex_replace(csv, std::regex("((?:[^,\\n]*,){10})[^\\n]*"), "$1");
  }

  // Options for a flight that renders quickly.
  static constexpr const char* kSmall =
      " --set frames=2 --set rate_hz=1 --set ground.map_px=256 --set shutter.rays_per_pixel=4";
};

TEST_F(SimulateCommandTest, LandsOnSimulatedRecording) {
  const std::string flight = folder_ / "flight";
  const Outcome simulated =
      Succeed("simulate landing --scenario calm --seed 2 --output " + flight + kSmall);
  EXPECT_THAT(simulated.err, HasSubstr("2 images"));
  const Outcome landed = Succeed("land " + flight);
  EXPECT_THAT(landed.err, HasSubstr("2 frames, pattern found in 2"));
  Succeed("land " + flight + " --output " + folder_ / "out");
  EXPECT_THAT(Run("evaluate " + flight + " " + folder_ / "out").out,
              HasSubstr("| calm | all | 2 | 2 | 100.0 |"));
  ExpectInputError("simulate landing --scenario calm --seed 2 --output " + flight + kSmall,
                   "--force");
}

TEST_F(SimulateCommandTest, LandsOnRequestedTagOnly) {
  const std::string flight = folder_ / "flight";
  Succeed("simulate landing --target apriltag --target-id 7 --scenario calm --output " + flight +
          kSmall + " --set flight.start_altitude_m=3 --set flight.end_altitude_m=2");
  const std::string land = "land " + flight + " --target apriltag";
  EXPECT_THAT(Succeed(land + " --target-id 7").err, HasSubstr("found in 2"));
  EXPECT_THAT(Succeed(land + " --target-id 8").err, HasSubstr("found in 0"));
  ExpectInputError("land " + flight + " --target-id 7", "a ring-cross has no id");
  ExpectInputError(land + " --target-id 7 --set landing.target.apriltag.id=1",
                   "--target-id 7 and --set landing.target.apriltag.id=1");
}

TEST_F(SimulateCommandTest, SimulatesHuntWithUserCamera) {
  const std::string camera = folder_.Write("camera.yaml",
                                           "image_width: 160\nimage_height: 90\n"
                                           "distortion_model: plumb_bob\n"
                                           "camera_matrix: [100, 0, 80, 0, 100, 45, 0, 0, 1]\n"
                                           "distortion_coefficients: [0, 0, 0, 0, 0]\n");
  const std::string flight = folder_ / "hunt";
  Succeed("simulate hunt --output " + flight + " --camera " + camera + kSmall);
  const cv::Mat image = ReadImage(flight + "/mav0/cam0/data/100000000000.png");
  EXPECT_EQ(image.size(), cv::Size(160, 90));
  EXPECT_EQ(image.channels(), 3);
}

TEST_F(SimulateCommandTest, HuntWarnsOnceOfWrongGroundHeight) {
  const std::string flight = folder_ / "hunt";
  Succeed("simulate hunt --scenario descend --output " + flight + kSmall +
          " --set frames=8 --set rate_hz=10"
          " --set navigation.clock_offset_min_s=0"
          " --set navigation.clock_offset_max_s=0");
  EXPECT_THAT(Run("hunt " + flight).err, Not(HasSubstr("by the size of the objects")));
  const std::string reported = Run("hunt " + flight + " --set hunt.ground_height_m=-5").err;
  const std::string wording = "by the size of the objects the ground is at z = ";
  const std::size_t at = reported.find(wording);
  ASSERT_NE(at, std::string::npos) << reported;
  EXPECT_NEAR(std::stod(reported.substr(at + wording.size())), 0, 0.5) << reported;
  EXPECT_EQ(reported.find(wording, at + 1), std::string::npos) << "once";
  EXPECT_THAT(reported, HasSubstr("hunt.ground_height_m says -5 m: set hunt.ground_height_m="));
}

TEST_F(SimulateCommandTest, FliesTouchdownThatCanBeReplayed) {
  const std::string flight = folder_ / "flight";
  const Outcome flown = Succeed("simulate touchdown --seed 4 --annotate=images --output " + flight +
                                kSmall + " --set frames=4 --set rate_hz=10");
  EXPECT_THAT(flown.out, HasSubstr("still in the air after 0.3 s"));
  for (const char* file :
       {"touchdown.csv", "touchdown_path.csv", "touchdown.png", "summary.txt", "landing_track.csv",
        "mav0/landing_pattern0/data.csv", "annotated/mav0/cam0/data/100000000000.png"}) {
    EXPECT_TRUE(std::filesystem::exists(flight + "/" + file)) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(flight + ".part"));
  const Outcome landed = Succeed("land " + flight);
  EXPECT_EQ(InCamera(landed.out), InCamera(ReadFile(flight + "/landing_detections.csv")));
}

TEST_F(SimulateCommandTest, ListsScenariosAndPrintsOptions) {
  for (const char* name : {"calm", "aggressive", "figure8", "fast", "dark", "dust", "low-sun",
                           "stills", "lookalikes"}) {
    EXPECT_THAT(Run("simulate landing --list").out, HasSubstr(std::string(name) + " ")) << name;
  }
  EXPECT_THAT(Run("simulate hunt --list").out, HasSubstr("cuboids "));
  EXPECT_THAT(Run("simulate touchdown --list").out, HasSubstr("fast "));
  const Outcome options = Run("simulate landing --scenario dust --print-config");
  EXPECT_THAT(options.out, HasSubstr("material: sand "));
}

TEST_F(SimulateCommandTest, ReportsFaults) {
  const std::string output = " --output " + folder_ / "flight";
  ExpectInputError("simulate landing --scenario moon" + output, "no scenario 'moon'");
  ExpectInputError("simulate hunt --set objects.size_m=big" + output,
                   "objects.size_m is 'big', expected a finite number (m)");
  ExpectInputError("simulate landing --config " + folder_ / "none.yaml" + output, "none.yaml");
  ExpectInputError("simulate touchdown --set wind.min_mps=-1" + output, "wind.min_mps is -1");
  EXPECT_EQ(Run("simulate landing").status, 2) << "no output";
  EXPECT_EQ(Run("simulate landing --threads 0" + output).status, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "flight"));
}

}  // namespace
}  // namespace kestrel
