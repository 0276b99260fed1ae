// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/io/recording/test_files.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/io/ros_messages/serialization.h"
#include "kestrel/vision/objects/test_objects.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kDownwardCamera[] = R"(sensor_type: camera
T_BS:
  cols: 4
  rows: 4
  data: [1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1]
rate_hz: 10
resolution: [640, 480]
camera_model: pinhole
intrinsics: [500, 500, 319.5, 239.5]
distortion_model: none
distortion_coefficients: []
)";

class TeamCommandTest : public CommandTest {
 protected:
  // Six discs below a UAV that stands 4 m high and, later, six more 8 m away; its navigation is off
  // by 'bias'. Returns the folder.
  std::string WriteFlight(const std::string& name, const Eigen::Vector2d& bias) const {
    ObjectScene scene(4, /*tilt=*/0);
    const std::vector<std::pair<Eigen::Vector2d, cv::Scalar>> discs = {
        {{60, 60}, kRedPaint},   {{580, 80}, kGreenPaint},  {{80, 420}, kBluePaint},
        {{560, 400}, kRedPaint}, {{320, 250}, kGreenPaint}, {{300, 100}, kBluePaint},
    };
    for (const auto& [pixel, paint] : discs) {
      scene.DrawDisc(scene.PointUnder(pixel, 0.012), 0.1, paint);
    }
    WriteTestImage(folder_, name + "/mav0/cam0/data/image.png", scene.Image());
    std::string images = "#timestamp [ns],filename\n";
    std::string poses =
        "#timestamp [ns],p_WB_W_x [m],p_WB_W_y [m],p_WB_W_z [m],q_WB_w [],q_WB_x [],q_WB_y [],"
        "q_WB_z []\n";
    for (const int station : {0, 1}) {
      for (int i = 0; i < 10; ++i) {
        const std::int64_t time = 1'000'000'000 + station * 2'000'000'000LL + i * 100'000'000LL;
        poses += fmt::format("{},{},{},4,1,0,0,0\n", time, bias.x() + 8 * station, bias.y());
        if (i >= 3 && i < 8) images += fmt::format("{},image.png\n", time);
      }
    }
    folder_.Write(name + "/mav0/cam0/data.csv", images);
    folder_.Write(name + "/mav0/cam0/sensor.yaml", kDownwardCamera);
    folder_.Write(name + "/mav0/nav0/data.csv", poses);
    return folder_ / name;
  }

  bool HasDds(const std::string& flight) const {
    const Outcome outcome = Run("hunt " + flight + " --team test --set team.silence_s=0.3");
    if (outcome.status == 0) return true;
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(Lines(outcome.err), 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("built without DDS"));
    return false;
  }

  // Runs the commands that begin with 'first' and 'second' as UAVs "a" and "b" of one team, each
  // with a node of its own. Returns their outcome.
  int RunTeam(const std::string& first, const std::string& second, int silence_s = 30) const {
    const auto command = [&, domain = TestDomain()](const std::string& begin,
                                                    const std::string& uav) {
      return fmt::format(
          "{0} {1} '{2}' --output '{3}' --team test --dds {4} --set team.uav={5} "
          "--set dds.node={5} --set team.silence_s={6} 2>'{3}.said'",
          KESTREL_COMMAND, begin, folder_ / uav, folder_ / (uav + "_out"), domain, uav, silence_s);
    };
    const int status = std::system(fmt::format("({}) & ({}); b=$?; wait $! && exit $b",
                                               command(first, "a"), command(second, "b"))
                                       .c_str());
    return WEXITSTATUS(status);
  }

  std::string Printed(const std::string& uav) const {
    return ReadFile(folder_ / (uav + "_out.said"));
  }

  std::string TeamMapOf(const std::string& uav) const {
    return ReadFile(folder_ / (uav + "_out/team_map.csv"));
  }
};

int RowsThatEnd(const std::string& map, const std::string& end) {
  int rows = 0;
  for (std::size_t at = 0; (at = map.find(end, at)) != std::string::npos; ++at) ++rows;
  return rows;
}

TEST_F(TeamCommandTest, TwoHuntsShareOneMap) {
  const std::string first = WriteFlight("a", {0, 0});
  WriteFlight("b", {0.7, -0.5});
  if (!HasDds(first)) GTEST_SKIP() << "no DDS";
  ASSERT_EQ(RunTeam("hunt --origin 50,14", "hunt --origin 50,14"), 0)
      << Printed("a") << Printed("b");
  for (const std::string uav : {"a", "b"}) {
    EXPECT_EQ(Lines(ReadFile(folder_ / (uav + "_out/object_map.csv"))), 13);
    EXPECT_THAT(Printed(uav), HasSubstr("team: 2 UAVs, 12 objects"));
    EXPECT_EQ(Lines(ReadFile(folder_ / (uav + "_out/team_map.geojson"))), 14);
  }
  const std::string map = TeamMapOf("a");
  EXPECT_EQ(map, TeamMapOf("b"));
  EXPECT_EQ(Lines(map), 13) << map;
  EXPECT_EQ(RowsThatEnd(map, ",a b,\n"), 12) << map;  // both have it, nobody has claimed it
}

TEST_F(TeamCommandTest, EachUavClaimsAnotherObject) {
  const std::string first = WriteFlight("a", {0, 0});
  WriteFlight("b", {0.7, -0.5});
  if (!HasDds(first)) GTEST_SKIP() << "no DDS";
  const std::string hunt = "hunt --set team.claim=true";
  ASSERT_EQ(RunTeam(hunt, hunt), 0) << Printed("a") << Printed("b");
  const std::string map = TeamMapOf("a");
  EXPECT_EQ(map, TeamMapOf("b"));
  EXPECT_EQ(RowsThatEnd(map, ",a\n"), 1) << map;
  EXPECT_EQ(RowsThatEnd(map, ",b\n"), 1) << map;
  EXPECT_THAT(Printed("a"), HasSubstr("team: goes for "));
}

TEST_F(TeamCommandTest, PublishesTeamMapToRos2) {
  const std::string first = WriteFlight("a", {0, 0});
  WriteFlight("b", {0.7, -0.5});
  if (!HasDds(first)) GTEST_SKIP() << "no DDS";
  Ros2Node node(TestDomain(), {"listener"});
  node.Subscribe("/a/team_map", Detection3DArrayMessage::kType, kLatchedQos);
  node.Subscribe("/b/team_markers", MarkerArrayMessage::kType, kLatchedQos);
  ASSERT_EQ(RunTeam("hunt", "fly --hunt"), 0) << Printed("a") << Printed("b");
  std::map<std::size_t, std::string> heard;
  node.Take(std::chrono::seconds(1),
            [&](std::size_t i, std::string_view bytes) { heard[i] = std::string(bytes); });
  ASSERT_EQ(heard.size(), 2u);
  const auto map = ParseMessage<Detection3DArrayMessage>(heard[0], WireFormat::kCdr, "heard");
  EXPECT_EQ(map.header.frame_id, "map");
  ASSERT_EQ(map.detections.size(), 12u);
  EXPECT_EQ(
      std::count_if(map.detections.begin(), map.detections.end(),
                    [](const auto& one) { return one.results.at(0).hypothesis.class_id == "red"; }),
      4);
  const auto markers = ParseMessage<MarkerArrayMessage>(heard[1], WireFormat::kCdr, "heard");
  EXPECT_EQ(markers.markers.size(), 25u);  // two per object, one that deletes the others
}

TEST_F(TeamCommandTest, IgnoresUavsWithoutKey) {
  const std::string first = WriteFlight("a", {0, 0});
  WriteFlight("b", {0.7, -0.5});
  if (!HasDds(first)) GTEST_SKIP() << "no DDS";
  const auto with_key = [&](const std::string& name, char digit) {
    folder_.Write(name, std::string(64, digit) + "\n");
    std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_read);
    return "hunt --set 'team.key=" + (folder_ / name) + "'";
  };
  const std::string right = with_key("right.key", '1');
  const std::string wrong = with_key("wrong.key", '2');
  ASSERT_EQ(RunTeam(right, right), 0) << Printed("a") << Printed("b");
  EXPECT_THAT(Printed("a"), HasSubstr("team: 2 UAVs, 12 objects"));
  EXPECT_THAT(Printed("a"), Not(HasSubstr("refused")));
  ASSERT_EQ(RunTeam(right + " --force", wrong + " --force", /*silence_s=*/6), 0);
  for (const std::string uav : {"a", "b"}) {
    EXPECT_THAT(Printed(uav), HasSubstr("team: 1 UAVs, 12 objects"));
    EXPECT_THAT(Printed(uav), HasSubstr("not signed by the team's key"));
  }
}

TEST_F(TeamCommandTest, FlightSharesMapWithHunt) {
  const std::string first = WriteFlight("a", {0, 0});
  WriteFlight("b", {0.7, -0.5});
  if (!HasDds(first)) GTEST_SKIP() << "no DDS";
  ASSERT_EQ(RunTeam("hunt", "fly --hunt"), 0) << Printed("a") << Printed("b");
  EXPECT_THAT(Printed("b"), HasSubstr("team: 2 UAVs, 12 objects"));
  EXPECT_EQ(TeamMapOf("a"), TeamMapOf("b"));
  EXPECT_EQ(Lines(TeamMapOf("b")), 13) << TeamMapOf("b");
}

TEST_F(TeamCommandTest, ReportsFaults) {
  TestDomain();
  const std::string flight = WriteFlight("a", {0, 0});
  ExpectInputError("hunt " + flight + " --team 'two words'", "expected 1 to 32 letters");
  ExpectInputError("hunt " + flight + " --team t --still", "--still");
  ExpectInputError("hunt " + flight + "/mav0/cam0/data/image.png --team t --camera " + flight +
                       "/mav0/cam0/sensor.yaml",
                   "expected a source with poses");
  ExpectInputError("fly " + flight + "/mav0/cam0/data/image.png --hunt --team t --force --camera " +
                       flight + "/mav0/cam0/sensor.yaml",
                   "expected --autopilot or a source with poses");
  ExpectInputError("hunt " + flight + " --team t --set team.uav=a/b", "team.uav");
  ExpectInputError("hunt " + flight + " --team t --set team.key=none.key", "none.key");
  ExpectInputError("hunt " + flight + " --team t --dds 300", "0 to 232");
}

}  // namespace
}  // namespace kestrel
