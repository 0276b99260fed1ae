// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/tracking_camera.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/test_autopilot.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using ::testing::HasSubstr;

// Takes marks, unless the picture is too old.
class MarkedVision : public Vision {
 public:
  struct Mark {
    Time frame;
    cv::Rect2d box_px;
  };

  void AddPose(const PoseSample&) override {}
  void AddGimbal(const GimbalSample&) override {}
  Duration pose_lead() const override { return Duration::zero(); }
  Observation Process(const Frame& frame) override { return {frame, FollowObservation()}; }
  bool takes_marks() const override { return true; }
  void Mark(Time frame, const cv::Rect2d& box_px) override {
    if (frame < oldest) throw InputError("the marked picture is too old");
    marks.push_back({frame, box_px});
  }
  void Unmark() override { ++unmarked; }
  std::string Found() const override { return ""; }

  Time oldest{};
  std::vector<struct Mark> marks;
  int unmarked = 0;
};

class TrackingCameraTest : public AutopilotTest {
 protected:
  void StartCamera(FlightOptions options = {}) {
    Start();
    CameraCalibration calibration;
    calibration.intrinsics = {640, 480, 500, 500, 319.5, 239.5, DistortionModel::kNone, {}};
    camera_ = std::make_unique<TrackingCamera>(
        options, calibration, CameraStream{.uri = {}, .delay = [] { return Duration(50ms); }},
        autopilot_.get(), connection_.get(),
        [this](const std::string& text) { reported_ += text + "\n"; });
    PassAll(1);
  }
  // Time passes for the autopilot and for the camera; a frame shows the thing every 50 ms.
  void PassAll(double seconds) {
    for (int i = 0; i < std::lround(100 * seconds); ++i) {
      now_ += 10ms;
      if (steps_++ % 100 == 0) SendHeartbeat();
      if (steps_ % 100 == 1) SendMessage(mavlink::GpsGlobalOrigin{473977420, 85455940, 488000, 0});
      for (const auto& [time, answer] : std::exchange(due_, {})) SendMessage(answer);
      poses_in_world_.Add({now_, {Eigen::Quaterniond::Identity(), {0, 0, 30}}, BodyMotion()});
      if (steps_ % 5 == 0 && sees_) See();
      autopilot_->Tick(now_);
      camera_->Tick(now_, track_, poses_in_world_);
    }
  }
  void See() {
    track_.captured = now_;
    FollowObservation seen;
    seen.time = now_;
    seen.region = RegionReport{state_, {64, 48, 128, 96}, 1};
    seen.track_state = TrackState::kTracking;
    seen.target = TargetEstimate{now_, target_};
    track_.followed = seen;
  }
  void Command(std::uint16_t command, float param1 = 0, float param2 = 0, float param3 = 0,
               float param4 = 0) {
    mavlink::CommandLong message;
    message.target_system = 1;
    message.target_component = 100;
    message.command = command;
    message.param1 = param1;
    message.param2 = param2;
    message.param3 = param3;
    message.param4 = param4;
    mavlink::PacketParser().Parse(ground_.Write(message), [this](const mavlink::Packet& packet) {
      camera_->Handle(packet, now_);
    });
  }
  template <class Message>
  std::optional<Message> Last() const {
    const auto found = last_heard_.find(Message::kId);
    return found == last_heard_.end() ? std::nullopt : found->second.template As<Message>();
  }
  int Status() const { return Last<mavlink::CameraTrackingImageStatus>()->tracking_status; }

  std::unique_ptr<TrackingCamera> camera_;
  mavlink::PacketWriter ground_{255, 190};
  MarkedVision vision_;
  PoseHistory poses_in_world_{100, 500ms};
  TrackSnapshot track_;
  TurnState target_;
  RegionState state_ = RegionState::kFollowing;
  bool sees_ = false;
  int steps_ = 0;
  std::string reported_;
};

// 0.05 s until the ground station has the picture, and 0.1 s until it is on the screen.
TEST_F(TrackingCameraTest, MarkCountsInThePictureThatWasShown) {
  StartCamera();
  const Time clicked = now_;
  Command(mavlink::kCommandTrackRectangle, 0.1f, 0.2f, 0.3f, 0.4f);
  PassAll(0.1);
  EXPECT_EQ(heard_[mavlink::CommandAck::kId], 0) << "the vision has not taken it";
  camera_->ApplyMarks(now_, &vision_);
  ASSERT_EQ(vision_.marks.size(), 1u);
  EXPECT_EQ(vision_.marks[0].frame, clicked - 150ms);
  const cv::Rect2d& box = vision_.marks[0].box_px;
  EXPECT_NEAR(box.x, 64, 1e-4);
  EXPECT_NEAR(box.y, 96, 1e-4);
  EXPECT_NEAR(box.width, 128, 1e-4);
  EXPECT_NEAR(box.height, 96, 1e-4);
  PassAll(0.02);
  EXPECT_EQ(Last<mavlink::CommandAck>()->result, mavlink::kResultAccepted);
  EXPECT_EQ(last_heard_[mavlink::CommandAck::kId].component, 100);
  EXPECT_THAT(reported_, HasSubstr("follows what system 255 component 190 has marked"));
  Command(mavlink::kCommandStopTracking);
  camera_->ApplyMarks(now_, &vision_);
  EXPECT_EQ(vision_.unmarked, 1);
}

TEST_F(TrackingCameraTest, RefusedMarkHasItsReason) {
  StartCamera();
  vision_.oldest = now_ + 1s;
  Command(mavlink::kCommandTrackPoint, 0.5f, 0.5f);
  camera_->ApplyMarks(now_, &vision_);
  PassAll(0.02);
  EXPECT_EQ(Last<mavlink::CommandAck>()->result, mavlink::kResultTemporarilyRejected);
  EXPECT_THAT(reported_, HasSubstr("the marked picture is too old"));
  vision_.oldest = {};
  Command(mavlink::kCommandTrackPoint, 0.5f, 0.4f);
  PassAll(1.5);
  EXPECT_THAT(reported_, HasSubstr("the camera gives no picture"));
  camera_->ApplyMarks(now_, &vision_);
  EXPECT_TRUE(vision_.marks.empty()) << "it was refused, and is not followed later";
}

TEST_F(TrackingCameraTest, FrozenPicturesAreNotReportedAsFollowed) {
  StartCamera();
  Command(mavlink::kCommandSetMessageInterval, mavlink::CameraTrackingImageStatus::kId, 100'000);
  PassAll(0.2);
  EXPECT_EQ(Status(), 0) << "nothing is marked";
  sees_ = true;
  PassAll(0.5);
  EXPECT_EQ(Status(), 1);
  EXPECT_FLOAT_EQ(Last<mavlink::CameraTrackingImageStatus>()->rec_top_x, 0.1f);
  state_ = RegionState::kCoasting;
  PassAll(0.3);
  EXPECT_EQ(Status(), 1 | 8);
  state_ = RegionState::kFollowing;
  PassAll(0.2);
  sees_ = false;
  PassAll(0.3);
  EXPECT_EQ(Status(), 1);
  PassAll(0.4);
  EXPECT_EQ(Status(), 1 | 8);
  PassAll(0.6);
  EXPECT_EQ(Status(), 2);
  PassAll(5.5);
  EXPECT_EQ(Status(), 0);
  sees_ = true;
  PassAll(0.2);
  EXPECT_EQ(Status(), 1) << "it is found again";
}

TEST_F(TrackingCameraTest, PlaceOnEarthIsSentToOthersFourTimesASecond) {
  FlightOptions options;
  options.messages.sends_follow_target = true;
  StartCamera(options);
  target_.mean.segment<3>(TurnState::kPosition) << 40, 0, 0;
  target_.mean.segment<3>(TurnState::kVelocity) << 0, 3, 0;
  target_.covariance = TurnState::Matrix::Identity();
  sees_ = true;
  PassAll(1);
  heard_.clear();
  PassAll(5);
  EXPECT_NEAR(heard_[mavlink::FollowTarget::kId], 20, 1);
  const auto target = Last<mavlink::FollowTarget>();
  ASSERT_TRUE(target);
  EXPECT_NEAR(static_cast<double>(target->timestamp), BootMs(), 300) << "ms, not us";
  EXPECT_EQ(target->est_capabilities, 1 | 2);
  EXPECT_FLOAT_EQ(target->vel[0], 3);
  EXPECT_GT(target->position_cov[0], 0.9);
  EXPECT_EQ(heard_[mavlink::CameraTrackingGeoStatus::kId], 0) << "nobody has asked";
  Command(mavlink::kCommandSetMessageInterval, mavlink::CameraTrackingGeoStatus::kId, 200'000);
  PassAll(1);
  EXPECT_FLOAT_EQ(Last<mavlink::CameraTrackingGeoStatus>()->vel_n, 3);
  EXPECT_NEAR(Last<mavlink::CameraTrackingGeoStatus>()->dist, 50, 0.5);
}

TEST_F(TrackingCameraTest, DescribesItsLens) {
  StartCamera();
  EXPECT_GE(heard_[mavlink::Heartbeat::kId], 2);
  Command(mavlink::kCommandRequestMessage, mavlink::CameraFovStatus::kId);
  EXPECT_NEAR(Last<mavlink::CameraFovStatus>()->hfov, 65.2, 0.1);
  EXPECT_NEAR(Last<mavlink::CameraFovStatus>()->vfov, 51.2, 0.1);
}

TEST_F(TrackingCameraTest, CameraHasAnIdOfItsOwn) {
  FlightOptions options;
  options.link.camera_id = options.link.component_id;
  EXPECT_THAT(InputErrorOf([&] { StartCamera(options); }), HasSubstr("fly.link.camera_id is 191"));
}

}  // namespace
}  // namespace kestrel
