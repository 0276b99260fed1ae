// SPDX-License-Identifier: BSD-3-Clause
// The component as ground stations use it: the sequences of messages of QGroundControl, Mission
// Planner and MAVSDK.
#include "kestrel/comms/mavlink/camera_component.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/packet_parser.h"
#include "kestrel/comms/mavlink/packet_writer.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kSystem = 1;

struct GroundStation {
  std::uint8_t system = 255;
  std::uint8_t component = 190;
};
constexpr GroundStation kQGroundControl{255, 190}, kMissionPlanner{254, 190}, kMavsdk{245, 190};

struct Marked {
  int request;
  ImageRegion region;
  Time time;
};

class CameraComponentTest : public testing::Test {
 protected:
  explicit CameraComponentTest(const std::string& stream_uri = "")
      : camera_({.component = 100,
                 .model = "front",
                 .width_px = 640,
                 .height_px = 480,
                 .horizontal_fov_deg = 65.2,
                 .vertical_fov_deg = 51.3,
                 .stream_uri = stream_uri,
                 .stream_rate_hz = 15},
                {.send = [this](const CameraMessage& message) { sent_.push_back(message); },
                 .mark =
                     [this](int request, const ImageRegion& region, Time time) {
                       marks_.push_back({request, region, time});
                     },
                 .stop = [this] { ++stops_; },
                 .report =
                     [this](const std::string& text, bool is_warning) {
                       (is_warning ? warnings_ : reports_) += text + "\n";
                     }}) {}

  template <class Message>
  void Receive(const Message& message, const GroundStation& from) {
    mavlink::PacketWriter writer(from.system, from.component);
    mavlink::PacketParser parser;
    parser.Parse(writer.Write(message),
                 [&](const mavlink::Packet& packet) { camera_.Handle(packet, kSystem, now_); });
  }
  // Sends a command with the parameters that are given; the others are 0.
  void Command(std::uint16_t command, const std::vector<float>& parameters,
               const GroundStation& from = kQGroundControl, std::uint8_t confirmation = 0,
               std::uint8_t component = 100) {
    mavlink::CommandLong message;
    message.target_system = kSystem;
    message.target_component = component;
    message.command = command;
    message.confirmation = confirmation;
    float* const fields[] = {&message.param1, &message.param2, &message.param3, &message.param4,
                             &message.param5, &message.param6, &message.param7};
    for (std::size_t i = 0; i < parameters.size(); ++i) *fields[i] = parameters[i];
    Receive(message, from);
  }
  void Pass(double seconds) {
    for (int i = 0; i < std::lround(100 * seconds); ++i) {
      now_ += std::chrono::milliseconds(10);
      camera_.Tick(now_, tracking_);
    }
  }

  // The messages of a kind that were sent; forgets all.
  template <class Message>
  std::vector<Message> Sent() {
    std::vector<Message> messages;
    for (const CameraMessage& one : std::exchange(sent_, {})) {
      if (const auto* message = std::get_if<Message>(&one)) messages.push_back(*message);
    }
    return messages;
  }
  // The results of the acknowledgements, by command.
  std::vector<std::pair<int, int>> Results() {
    std::vector<std::pair<int, int>> results;
    for (const auto& ack : Sent<mavlink::CommandAck>()) {
      results.emplace_back(ack.command, ack.result);
    }
    return results;
  }
  void Follow(const ImageRegion& region) {
    tracking_ = {.state = CameraTracking::State::kActive, .region = region};
  }

  Time now_ = TimeFromNanoseconds(50'000'000'000);
  CameraTracking tracking_;
  std::vector<CameraMessage> sent_;
  std::vector<Marked> marks_;
  int stops_ = 0;
  std::string reports_, warnings_;
  CameraComponent camera_;
};

class StreamingCameraComponentTest : public CameraComponentTest {
 protected:
  StreamingCameraComponentTest() : CameraComponentTest("rtsp://192.168.2.5:8554/kestrel") {}
};

TEST_F(CameraComponentTest, HeartbeatIsThatOfACamera) {
  Pass(3);
  const auto heartbeats = Sent<mavlink::Heartbeat>();
  ASSERT_EQ(heartbeats.size(), 3u);
  EXPECT_EQ(heartbeats[0].type, 30);
  EXPECT_EQ(heartbeats[0].autopilot, 8);
}

// QGroundControl asks alternately in the new way and the old one.
TEST_F(StreamingCameraComponentTest, QGroundControlDiscoversCameraAndStream) {
  Command(512, {259});
  EXPECT_THAT(Results(), ElementsAre(std::pair(512, 0)));
  Command(521, {1});
  const auto information = Sent<mavlink::CameraInformation>();
  ASSERT_EQ(information.size(), 1u);
  EXPECT_EQ(information[0].flags, 256u | 512u | 1024u | 2048u);
  EXPECT_EQ(information[0].resolution_h, 640);
  EXPECT_EQ(information[0].resolution_v, 480);
  EXPECT_EQ(std::string(information[0].model_name.begin(), information[0].model_name.begin() + 6),
            std::string("front\0", 6));
  EXPECT_EQ(information[0].time_boot_ms, 50'000u);
  Command(2504, {0});
  const auto stream = Sent<mavlink::VideoStreamInformation>();
  ASSERT_EQ(stream.size(), 1u);
  EXPECT_STREQ(stream[0].uri.data(), "rtsp://192.168.2.5:8554/kestrel");
  EXPECT_EQ(stream[0].type, 0);
  EXPECT_EQ(stream[0].encoding, 1);
  EXPECT_EQ(stream[0].hfov, 65);
  EXPECT_EQ(stream[0].framerate, 15);
  for (const float id : {260.0f, 262.0f, 270.0f, 271.0f}) Command(512, {id});
  EXPECT_THAT(Results(), ElementsAre(std::pair(512, 0), std::pair(512, 0), std::pair(512, 0),
                                     std::pair(512, 0)));
}

TEST_F(CameraComponentTest, StreamThatIsNotThereIsNotReported) {
  Command(521, {1});
  EXPECT_EQ(Sent<mavlink::CameraInformation>().at(0).flags, 512u | 1024u | 2048u);
  Command(2504, {0});
  Command(512, {269});
  EXPECT_THAT(Results(), ElementsAre(std::pair(2504, 3), std::pair(512, 3)));
}

// Clicks on the picture, and asks for the status twice a second.
TEST_F(CameraComponentTest, QGroundControlMarksPointAndStops) {
  Pass(1);
  EXPECT_THAT(Sent<mavlink::CameraTrackingImageStatus>(), IsEmpty()) << "nobody has asked";
  Command(2004, {0.5f, 0.25f, 0.02f, 0});
  Command(511, {275, 500'000});
  EXPECT_THAT(Results(), ElementsAre(std::pair(511, 0))) << "the mark has no outcome yet";
  ASSERT_EQ(marks_.size(), 1u);
  EXPECT_EQ(marks_[0].time, now_);
  EXPECT_NEAR(marks_[0].region.left, 0.48, 1e-6);
  EXPECT_NEAR(marks_[0].region.right, 0.52, 1e-6);
  EXPECT_NEAR(marks_[0].region.bottom - marks_[0].region.top, 0.04 * 640 / 480, 1e-6);
  camera_.Answer(marks_[0].request, "");
  const auto acks = Sent<mavlink::CommandAck>();
  ASSERT_EQ(acks.size(), 1u);
  EXPECT_EQ(acks[0].command, 2004);
  EXPECT_EQ(acks[0].result, 0);
  EXPECT_EQ(acks[0].target_system, 255);
  EXPECT_EQ(acks[0].target_component, 190);
  EXPECT_THAT(reports_, HasSubstr("system 255 component 190 has marked: 26 x 26 px"));
  Follow({0.4, 0.2, 0.5, 0.4});
  Pass(5);
  const auto statuses = Sent<mavlink::CameraTrackingImageStatus>();
  ASSERT_EQ(statuses.size(), 10u);
  EXPECT_EQ(statuses[0].tracking_status, 1);
  EXPECT_EQ(statuses[0].tracking_mode, 2);
  EXPECT_EQ(statuses[0].target_data, 4) << "there is no video in which it is drawn";
  EXPECT_FLOAT_EQ(statuses[0].rec_top_x, 0.4f);
  EXPECT_FLOAT_EQ(statuses[0].rec_bottom_y, 0.4f);
  EXPECT_TRUE(std::isnan(statuses[0].point_x));
  Command(2010, {});
  Command(511, {275, -1});
  EXPECT_EQ(stops_, 1);
  EXPECT_THAT(Results(), ElementsAre(std::pair(2010, 0), std::pair(511, 0)));
  Pass(3);
  EXPECT_THAT(Sent<mavlink::CameraTrackingImageStatus>(), IsEmpty());
}

TEST_F(StreamingCameraComponentTest, StatusIsAMask) {
  Command(511, {275, 100'000});
  const ImageRegion region{0.4, 0.2, 0.5, 0.4};
  const auto status = [&](CameraTracking::State state, std::optional<ImageRegion> where) {
    tracking_ = {.state = state, .region = where};
    Pass(0.2);
    return Sent<mavlink::CameraTrackingImageStatus>().back();
  };
  EXPECT_EQ(status(CameraTracking::State::kActive, region).tracking_status, 1);
  EXPECT_EQ(status(CameraTracking::State::kActive, region).target_data, 2 | 4);
  EXPECT_EQ(status(CameraTracking::State::kCoasting, region).tracking_status, 1 | 8);
  const auto lost = status(CameraTracking::State::kLost, std::nullopt);
  EXPECT_EQ(lost.tracking_status, 2);
  EXPECT_EQ(lost.tracking_mode, 0);
  EXPECT_TRUE(std::isnan(lost.rec_top_x));
  EXPECT_EQ(status(CameraTracking::State::kIdle, std::nullopt).tracking_status, 0);
}

// It wants the interval back, and tries three times.
TEST_F(CameraComponentTest, MissionPlannerReadsIntervalsBack) {
  Command(511, {259, 30e6f}, kMissionPlanner);
  Command(510, {259}, kMissionPlanner);
  const auto intervals = Sent<mavlink::MessageInterval>();
  ASSERT_EQ(intervals.size(), 1u);
  EXPECT_EQ(intervals[0].message_id, 259);
  EXPECT_EQ(intervals[0].interval_us, 30'000'000);
  Pass(61);
  EXPECT_EQ(Sent<mavlink::CameraInformation>().size(), 3u);
  Command(511, {275, 5e6f}, kMissionPlanner);
  Command(511, {275, 0}, kMissionPlanner);
  Command(510, {275}, kMissionPlanner);
  EXPECT_EQ(Sent<mavlink::MessageInterval>().at(0).interval_us, -1);
  Pass(11);
  EXPECT_THAT(Sent<mavlink::CameraTrackingImageStatus>(), IsEmpty());
}

TEST_F(CameraComponentTest, RejectsMalformedInterval) {
  for (const float interval_us : {kNan, -2.0f, 1e10f}) Command(511, {275, interval_us});
  Command(511, {kNan, 1e6f});
  Command(511, {30, 1e6f});
  EXPECT_THAT(Results(), ElementsAre(std::pair(511, 2), std::pair(511, 2), std::pair(511, 2),
                                     std::pair(511, 3), std::pair(511, 3)));
  Command(511, {275, 1});
  Command(510, {275});
  EXPECT_EQ(Sent<mavlink::MessageInterval>().at(0).interval_us, 50'000) << "no flood";
}

// MAVSDK leaves parameters out that it does not know, and repeats a command after half a second.
TEST_F(CameraComponentTest, MavsdkRepeatsMarkUntilItIsAnswered) {
  for (std::uint8_t confirmation = 0; confirmation < 2; ++confirmation) {
    Command(2005, {0.1f, 0.2f, 0.3f, 0.4f, kNan, kNan, kNan}, kMavsdk, confirmation);
    Pass(0.4);
  }
  ASSERT_EQ(marks_.size(), 1u);
  EXPECT_FLOAT_EQ(static_cast<float>(marks_[0].region.right), 0.3f);
  EXPECT_THAT(Results(), IsEmpty());
  camera_.Answer(marks_[0].request, "");
  EXPECT_THAT(Results(), ElementsAre(std::pair(2005, 0)));
  // The acknowledgement was lost.
  Pass(2.5);
  Command(2005, {0.1f, 0.2f, 0.3f, 0.4f, kNan, kNan, kNan}, kMavsdk, 1);
  EXPECT_THAT(Results(), ElementsAre(std::pair(2005, 0)));
  EXPECT_EQ(marks_.size(), 1u);
  // The same region is marked anew.
  Command(2005, {0.1f, 0.2f, 0.3f, 0.4f, kNan, kNan, kNan}, kMavsdk);
  EXPECT_EQ(marks_.size(), 2u);
}

TEST_F(CameraComponentTest, SameMarkAfterStopIsNew) {
  Command(2005, {0.1f, 0.2f, 0.3f, 0.4f});
  camera_.Answer(marks_.at(0).request, "");
  Command(2010, {});
  Command(2005, {0.1f, 0.2f, 0.3f, 0.4f});
  EXPECT_EQ(marks_.size(), 2u);
}

TEST_F(CameraComponentTest, TwoGroundStationsDoNotDisturbEachOther) {
  Command(511, {275, 500'000}, kQGroundControl);
  Command(511, {275, 200'000}, kMissionPlanner);
  Pass(2);
  EXPECT_EQ(Sent<mavlink::CameraTrackingImageStatus>().size(), 10u);
  Command(511, {275, -1}, kMissionPlanner);
  Pass(2);
  EXPECT_EQ(Sent<mavlink::CameraTrackingImageStatus>().size(), 4u) << "one still wants them";
  Command(2005, {0.1f, 0.2f, 0.3f, 0.4f}, kQGroundControl);
  Command(2005, {0.5f, 0.6f, 0.7f, 0.8f}, kMissionPlanner);
  ASSERT_EQ(marks_.size(), 2u);
  for (const Marked& mark : marks_) camera_.Answer(mark.request, "");
  const auto acks = Sent<mavlink::CommandAck>();
  ASSERT_EQ(acks.size(), 2u);
  EXPECT_EQ(acks[0].target_system, kQGroundControl.system);
  EXPECT_EQ(acks[1].target_system, kMissionPlanner.system);
  Command(2005, {0.1f, 0.2f, 0.3f, 0.4f}, kQGroundControl, 1);
  EXPECT_EQ(marks_.size(), 2u) << "a repetition does not take the mark back from the other one";
}

TEST_F(CameraComponentTest, RequestsAreTakenAgainAfterLinkWasLost) {
  Command(511, {275, 500'000});
  Pass(60);  // the ground station is silent, and begins again
  Sent<mavlink::Heartbeat>();
  Command(521, {1});
  EXPECT_EQ(Sent<mavlink::CameraInformation>().size(), 1u);
  Command(511, {275, 500'000});
  Pass(1);
  EXPECT_EQ(Sent<mavlink::CameraTrackingImageStatus>().size(), 2u);
}

TEST_F(CameraComponentTest, RefusesMarkThatIsNoRegionOfThePicture) {
  const std::vector<std::pair<std::uint16_t, std::vector<float>>> marks = {
      {2005, {kNan, 0.2f, 0.3f, 0.4f}},  {2005, {0.1f, 0.2f, 0.3f, 1.2f}},
      {2005, {-0.1f, 0.2f, 0.3f, 0.4f}}, {2005, {0.3f, 0.2f, 0.1f, 0.4f}},
      {2005, {0.1f, 0.2f, 0.1f, 0.2f}},  {2005, {0.1f, 0.2f, 0.102f, 0.4f}},
      {2004, {kNan, 0.5f, 0}},           {2004, {0.5f, 1.5f, 0}},
      {2004, {0.5f, 0.5f, -0.1f}},       {2004, {0.5f, 0.5f, 0.6f}},
      {2004, {0.5f, 0.5f, 0.001f}},      {2004, {INFINITY, 0.5f, 0.1f}}};
  for (const auto& [command, parameters] : marks) {
    Command(command, parameters);
    EXPECT_THAT(Results(), ElementsAre(std::pair<int, int>(command, 2)));
  }
  EXPECT_THAT(marks_, IsEmpty());
  EXPECT_THAT(warnings_, HasSubstr("the mark of system 255 component 190 is refused: it is not "
                                   "within the picture"));
  EXPECT_THAT(warnings_, HasSubstr("it is smaller than 4 px"));
}

TEST_F(CameraComponentTest, PointWithoutRadiusHasARegion) {
  Command(2004, {0.5f, 0.5f, 0}, kMissionPlanner);
  Command(2004, {0.5f, 0.4f, kNan, kNan}, kMavsdk);
  ASSERT_EQ(marks_.size(), 2u);
  for (const Marked& mark : marks_) {
    EXPECT_NEAR((mark.region.right - mark.region.left) * 640, 38.4, 0.01);
    EXPECT_NEAR((mark.region.bottom - mark.region.top) * 480, 38.4, 0.01);
  }
}

TEST_F(CameraComponentTest, MarkNamesItsCamera) {
  Command(2004, {0.5f, 0.5f, 0, 100});
  EXPECT_EQ(marks_.size(), 1u);
  sent_.clear();
  Command(2004, {0.5f, 0.5f, 0, 101});
  Command(2005, {0.1f, 0.2f, 0.3f, 0.4f, 1});
  Command(2010, {101});
  EXPECT_THAT(Results(), ElementsAre(std::pair(2004, 2), std::pair(2005, 2), std::pair(2010, 2)));
  EXPECT_EQ(marks_.size(), 1u);
  EXPECT_EQ(stops_, 0);
}

TEST_F(CameraComponentTest, MarkWithoutPictureIsRefusedForTheMoment) {
  Command(2005, {0.1f, 0.2f, 0.3f, 0.4f});
  camera_.Answer(marks_.at(0).request, "the marked picture is too old");
  EXPECT_THAT(Results(), ElementsAre(std::pair(2005, 1)));
  EXPECT_THAT(warnings_, HasSubstr("is refused: the marked picture is too old"));
  Command(2005, {0.2f, 0.2f, 0.3f, 0.4f});
  Pass(1.5);
  EXPECT_THAT(Results(), ElementsAre(std::pair(2005, 1)));
  EXPECT_THAT(warnings_, HasSubstr("the camera gives no picture"));
  camera_.Answer(marks_.at(1).request, "");
  EXPECT_THAT(Results(), IsEmpty()) << "it was answered";
}

TEST_F(CameraComponentTest, CommandsOfOthersAreNotAnswered) {
  Command(512, {259}, kQGroundControl, 0, /*component=*/1);
  Command(2004, {0.5f, 0.5f, 0}, kQGroundControl, 0, /*component=*/101);
  Command(400, {1}, kQGroundControl, 0, /*component=*/0);
  EXPECT_THAT(sent_, IsEmpty());
  EXPECT_THAT(marks_, IsEmpty());
  Command(512, {259}, kQGroundControl, 0, /*component=*/0);
  EXPECT_THAT(Results(), ElementsAre(std::pair(512, 0))) << "all components are asked";
  Command(400, {1});
  EXPECT_THAT(Results(), ElementsAre(std::pair(400, 3)));
}

TEST_F(CameraComponentTest, ForeignHeartbeatWithItsIdIsReportedOnce) {
  mavlink::Heartbeat heartbeat;
  heartbeat.type = 30;
  for (int i = 0; i < 3; ++i) Receive(heartbeat, {kSystem, 100});
  Receive(heartbeat, {kSystem, 101});
  Receive(heartbeat, {2, 100});
  EXPECT_EQ(warnings_,
            "another camera sends as system 1 component 100, or the link sends our own messages "
            "back: expected another fly.link.camera_id\n");
}

TEST_F(CameraComponentTest, PlaceIsThatOfTheTarget) {
  TargetState target;
  target.world_from_body.translation = {0, 0, 30};
  target.position_in_world = {40, 0, 0};
  target.velocity_in_world = {2, 0, 0};  // to the east
  target.covariance.diagonal() << 4, 5, 0.25;
  const GlobalPosition origin{473'977'420, 85'455'940, 488};
  tracking_ = {.state = CameraTracking::State::kActive,
               .place = GeoStatusOf(target, AutopilotKind::kPx4, origin)};
  Command(511, {276, 200'000});
  Pass(0.1);
  const auto statuses = Sent<mavlink::CameraTrackingGeoStatus>();
  ASSERT_EQ(statuses.size(), 1u);
  EXPECT_EQ(statuses[0].tracking_status, 1);
  EXPECT_EQ(statuses[0].lat, origin.latitude_e7);
  EXPECT_GT(statuses[0].lon, origin.longitude_e7 + 5000);
  EXPECT_FLOAT_EQ(statuses[0].alt, 488);
  EXPECT_FLOAT_EQ(statuses[0].h_acc, 3);
  EXPECT_FLOAT_EQ(statuses[0].v_acc, 0.5);
  EXPECT_FLOAT_EQ(statuses[0].vel_e, 2);
  EXPECT_FLOAT_EQ(statuses[0].dist, 50);
  EXPECT_FLOAT_EQ(statuses[0].hdg, static_cast<float>(std::acos(-1.0) / 2));
  tracking_ = {};
  Pass(0.2);
  const auto idle = Sent<mavlink::CameraTrackingGeoStatus>().at(0);
  EXPECT_EQ(idle.tracking_status, 0);
  EXPECT_EQ(idle.lat, std::numeric_limits<std::int32_t>::max());
  EXPECT_TRUE(std::isnan(idle.dist));
}

// Frames of node-mavlink (system 1, component 100).
template <class Message>
std::string HexOf(const Message& message, int sequence) {
  mavlink::PacketWriter writer(1, 100);
  for (int i = 0; i < sequence; ++i) writer.Write(mavlink::Heartbeat{});
  std::string digits;
  for (const std::uint8_t byte : writer.Write(message)) digits += fmt::format("{:02x}", byte);
  return digits;
}

TEST(CameraMessagesTest, AreThoseOfAnotherImplementation) {
  constexpr std::int32_t kUnknown = std::numeric_limits<std::int32_t>::max();
  EXPECT_EQ(
      HexOf(mavlink::CameraTrackingImageStatus{9, 2, 6, kNan, kNan, kNan, .25, .5, .375, .75}, 0),
      "fd1f00000001641301000000c07f0000c07f0000c07f0000803e0000003f0000c03e0000403f09020617d0");
  EXPECT_EQ(
      HexOf(mavlink::CameraTrackingGeoStatus{1, 473977420, 85455940, 488.5, 1.5, .5, 2, -1, 0, kNan,
                                             32.25, 1.25, kNan},
            1),
      "fd3100000101641401004c52401c44f417050040f4430000c03f0000003f00000040000080bf000000000000"
      "c07f000001420000a03f0000c07f01fa3f");
  EXPECT_EQ(HexOf(mavlink::CameraSettings{1234, 1, kNan, kNan}, 2),
            "fd0d0000020164040100d2040000010000c07f0000c07f682e");
  EXPECT_EQ(HexOf(mavlink::CameraCaptureStatus{1234, 0, 0, 0, 77, 2.5}, 3),
            "fd100000030164060100d2040000000000004d00000000002040520f");
  EXPECT_EQ(HexOf(mavlink::VideoStreamStatus{1, 1, 15, 640, 480, 1'000'000, 0, 65}, 4),
            "fd1300000401640e01000000704140420f0001008002e0010000410001053e");
  EXPECT_EQ(
      HexOf(mavlink::CameraFovStatus{1234,
                                     kUnknown,
                                     kUnknown,
                                     kUnknown,
                                     kUnknown,
                                     kUnknown,
                                     kUnknown,
                                     {1, 0, 0, 0},
                                     65.5,
                                     51.25},
            5),
      "fd3400000501640f0100d2040000ffffff7fffffff7fffffff7fffffff7fffffff7fffffff7f0000803f0000"
      "000000000000000000000000834200004d424998");
}

}  // namespace
}  // namespace kestrel
