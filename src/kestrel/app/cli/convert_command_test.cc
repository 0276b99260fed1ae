// SPDX-License-Identifier: BSD-3-Clause
// Tests bags as users have them: `kestrel convert`, and `land` and `hunt` with bags.
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/app/foxglove/test_protobuf.h"
#include "kestrel/core/camera/calibration_reader.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

namespace fs = std::filesystem;

// The table without the columns that necessarily differ for a bag: name of a frame and duration.
std::string Comparable(const std::string& csv) {
  std::istringstream lines(csv);
  std::set<std::size_t> left_out;
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      if (cell == "frame" || cell == "detect_ms") left_out.insert(column);
      if (!left_out.contains(column)) kept += cell + ",";
    }
    kept += "\n";
  }
  return kept;
}

class ConvertCommandTest : public CommandTest {
 protected:
  static constexpr const char* kLanding = "--scenario calm --seed 2 --set frames=3 --set rate_hz=2";

  std::string Convert(const std::string& source, const std::string& arguments) const {
    const std::string destination = folder_ / arguments;
    const Outcome outcome = Succeed("convert " + source + " " + destination);
    EXPECT_THAT(outcome.err, HasSubstr("3 frames, "));
    return destination.substr(0, destination.find(' '));
  }
  // The text of the file that 'command' writes for a source.
  std::string Result(const std::string& command, const std::string& source,
                     const std::string& file) const {
    const std::string output = source + "." + command;
    Succeed(command + " " + source + " --output " + output + " --force");
    return ReadFile(output + "/" + file);
  }
};

TEST_F(ConvertCommandTest, LandGivesSameResultForBagAndRecording) {
  const std::string flight = Simulate("landing", kLanding);
  const std::string detections = Result("land", flight, "landing_detections.csv");
  const std::string track = Result("land", flight, "landing_track.csv");
  EXPECT_EQ(Lines(detections), 4);
  EXPECT_GT(Lines(track), 1);
  for (const char* destination :
       {"ros1.bag --compression lz4", "ros2.mcap --compression zstd", "ros2.db3"}) {
    const std::string bag = Convert(flight, destination);
    EXPECT_EQ(Comparable(Result("land", bag, "landing_detections.csv")), Comparable(detections))
        << destination;
    EXPECT_EQ(ReadFile(bag + ".land/landing_track.csv"), track) << destination;
  }
  const std::string back = Convert(folder_ / "ros2.db3", "back");
  EXPECT_EQ(ReadFile(back + "/mav0/cam0/data.csv"), ReadFile(flight + "/mav0/cam0/data.csv"));

  // The cut bag is read up to the cut, and the command says so.
  const std::string cut = Convert(flight, "cut.mcap");
  TestFolder::CutOff(cut, 0.8);
  const Outcome outcome = Succeed("land " + cut);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("cut.mcap: was not closed"), HasSubstr("2 frames")));
}

TEST_F(ConvertCommandTest, HuntGivesSameResultForBagAndRecording) {
  const std::string flight =
      Simulate("hunt", "--scenario descend --seed 2 --set frames=3 --set rate_hz=2");
  const std::string detections = Result("hunt", flight, "object_detections.csv");
  const std::string bag = Convert(flight, "hunt.bag --compression bz2");
  EXPECT_EQ(Comparable(Result("hunt", bag, "object_detections.csv")), Comparable(detections));
  EXPECT_EQ(ReadFile(bag + ".hunt/object_map.csv"), ReadFile(flight + ".hunt/object_map.csv"));
}

TEST_F(ConvertCommandTest, CalibrateGivesSameResultForBagAndRecording) {
  const std::string flight =
      Simulate("landing", "--scenario aggressive --seed 11 --set frames=60 --set rate_hz=15");
  const std::string bag = folder_ / "flight.mcap";
  Succeed("convert " + flight + " " + bag);
  // A bag cannot hold a clock offset to start from.
  const std::string calibrate =
      "calibrate clock --both --moving --camera " + flight + "/mav0/cam0/sensor.yaml ";
  const auto result = [&](const std::string& source) {
    const std::string file = folder_ / "camera.yaml";
    Succeed(calibrate + source + " --force --output " + file);
    return ReadCalibration(file);
  };
  const CameraCalibration of_flight = result(flight);
  const CameraCalibration of_bag = result(bag + " --topic /camera/image_raw");
  EXPECT_TRUE(
      of_bag.body_from_camera->rotation.isApprox(of_flight.body_from_camera->rotation, 1e-6));
  EXPECT_NEAR(ToSeconds(*of_bag.clock_offset), ToSeconds(*of_flight.clock_offset), 1e-6);
  EXPECT_GT(ToSeconds(*of_flight.clock_offset), 0.1);
  ExpectInputError(calibrate + bag + " --topic /up", "flight.mcap: has no topic /up");
  EXPECT_THAT(Run("calibrate lens " + bag + " --topic /camera/image_raw").err,
              HasSubstr("60 images"));
  ExpectInputError("calibrate lens " + bag + " --topic /up", "flight.mcap: has no topic /up");
}

TEST_F(ConvertCommandTest, WritesFoxgloveMessages) {
  const std::string flight = Simulate("landing", kLanding);
  const auto messages = ReadMessages(Convert(flight, "flight.mcap --foxglove"));
  ASSERT_EQ(messages.at("/camera/image").size(), 3u);
  EXPECT_EQ(messages.at("/camera/calibration").size(), 3u);
  EXPECT_GT(messages.at("/pose").size(), 3u);
  EXPECT_EQ(messages.at("/tf").size(), messages.at("/pose").size() + 3);
  const StoredMessage& image = messages.at("/camera/image")[2];
  EXPECT_EQ(image.fields.time(1), image.time);
  ExpectInputError("convert " + flight + " " + folder_ / "flight.mcap --foxglove",
                   "flight.mcap: is there already");
  // The file is a recording as any other one.
  const std::string back = Convert(folder_ / "flight.mcap", "back");
  const std::string poses = "/mav0/nav0/data.csv";
  EXPECT_EQ(Lines(ReadFile(back + poses)), Lines(ReadFile(flight + poses)));
  const std::string sensor = "/mav0/cam0/sensor.yaml";
  const CameraCalibration found = ReadCalibration(back + sensor);
  const CameraCalibration written = ReadCalibration(flight + sensor);
  EXPECT_EQ(found.intrinsics.distortion, written.intrinsics.distortion);
  EXPECT_EQ(found.intrinsics.fx_px, written.intrinsics.fx_px);
  ASSERT_TRUE(found.body_from_camera);
  EXPECT_TRUE(found.body_from_camera->rotation.isApprox(written.body_from_camera->rotation, 1e-9));
  const std::string detections = Result("land", folder_ / "flight.mcap", "landing_detections.csv");
  EXPECT_EQ(Lines(detections), 4);
  EXPECT_THAT(detections, HasSubstr("camera/image/100"));
  ExpectInputError("convert " + flight + " " + folder_ / "flight.bag --foxglove",
                   "flight.bag: expected a name that ends in .mcap");
}

TEST_F(ConvertCommandTest, ReportsFaults) {
  const std::string flight = Simulate("landing", kLanding);
  const std::string bag = Convert(flight, "flight.bag");
  const std::string convert = "convert " + flight + " ";
  ExpectInputError(convert + bag, "flight.bag: is there already; --force replaces it");
  ExpectInputError("convert " + bag + " " + flight, "exists already; --force replaces it");
  ExpectInputError(convert + (folder_ / "new.bag") + " --compression zstd",
                   "cannot be written with compression zstd");
  ExpectInputError(convert + (folder_ / "new") + " --compression lz4", "expected no --compression");
  ExpectInputError(convert + (folder_ / "none/new.mcap"), "new.mcap: cannot be written");
  ExpectInputError("convert " + (folder_ / "none") + " " + (folder_ / "new.bag"), "none: no such");
  EXPECT_THAT(Run(convert + (folder_ / "told.bag")).err, HasSubstr("the truth of the simulation"));
  ExpectInputError(convert + (folder_ / "out.avi"), "out.avi: expected a bag");
  ExpectInputError(convert + flight + " --force", "is the source, expected another name");
  ExpectInputError("convert " + bag + " " + bag + " --force", "is the source");
  EXPECT_EQ(Run(convert + (folder_ / "new.bag") + " --compression zip").status, 2);
  EXPECT_FALSE(fs::exists(folder_ / "new.bag"));
  Succeed(convert + bag + " --force");

  ExpectInputError("land " + bag + " --topic /camera/up",
                   "flight.bag: has no topic /camera/up, expected one of /camera/image_raw");
  ExpectInputError("land " + flight + " --topic /camera/image_raw", "which the source is not");
  ExpectInputError("land " + bag + " " + bag, "expected no other source beside it");
  ExpectInputError("land " + folder_.Write("empty.bag", ""), "empty.bag: is no ROS 1 bag");
  ExpectInputError("hunt " + folder_.Write("garbage.mcap", "garbage"), "is no MCAP file");
  const std::string bare = folder_ / "bare";
  fs::copy(flight, bare, fs::copy_options::recursive);
  fs::remove(bare + "/mav0/cam0/sensor.yaml");
  const std::string blind = folder_ / "blind.bag";
  EXPECT_THAT(Run("convert " + bare + " " + blind).err, HasSubstr("no calibration"));
  EXPECT_THAT(Run("land " + blind).err, HasSubstr("no calibration: only places in the image"));
}

}  // namespace
}  // namespace kestrel
