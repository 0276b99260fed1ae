// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/ros_results.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;

class MessageList : public ResultConnection {
 public:
  bool HasSubscribers(ResultTopic /*topic*/) const override { return false; }
  void Publish(ResultTopic topic, const std::string& bytes) override {
    topics.push_back(topic);
    messages[topic] = bytes;
  }
  template <class Message>
  Message Newest(ResultTopic topic) const {
    return ParseMessage<Message>(messages.at(topic), WireFormat::kCdr, "published");
  }

  std::vector<ResultTopic> topics;
  std::map<ResultTopic, std::string> messages;  // the newest of each topic
};

CameraCalibration MountedCamera(const std::string& name, double x_m) {
  CameraCalibration calibration;
  calibration.intrinsics = PaperCamera();
  calibration.name = name;
  calibration.body_from_camera.emplace().translation.x() = x_m;
  return calibration;
}

// What two cameras publish, that are ahead of each other by 0.3 m.
struct TwoCameras {
  TwoCameras() {
    results.AddCamera(further, MountedCamera("cam1", 0.3));
    observation.report.detection.emplace();
    observation.world_from_camera.emplace();
    observation.camera_from_body.emplace();
    observation.target.emplace();
  }

  void Publish(std::size_t camera) {
    frame.camera = camera;
    results.Publish(frame, observation);
  }

  std::shared_ptr<MessageList> first = std::make_shared<MessageList>();
  std::shared_ptr<MessageList> further = std::make_shared<MessageList>();
  RosResults results{
      first,
      {},
      {.camera = "camera", .world = "map", .body = "base_link", .further = {"cam1_optical_frame"}},
      MountedCamera("cam0", 0),
      {},
      {}};
  LandingObservation observation;
  Frame frame;
};

TEST(RosResultsTest, FurtherCameraHasItsOwnTopicsAndFrames) {
  TwoCameras cameras;
  cameras.Publish(1);
  EXPECT_THAT(
      cameras.further->topics,
      ElementsAre(ResultTopic::kDetections, ResultTopic::kTargetPose, ResultTopic::kTransforms));
  const auto detections =
      cameras.further->Newest<Detection3DArrayMessage>(ResultTopic::kDetections);
  EXPECT_EQ(detections.header.frame_id, "cam1_optical_frame");
  const auto pattern = cameras.further->Newest<TfMessage>(ResultTopic::kTransforms).transforms;
  ASSERT_EQ(pattern.size(), 1u);
  EXPECT_EQ(pattern[0].header.frame_id, "cam1_optical_frame");
  EXPECT_EQ(pattern[0].child_frame_id, "cam1_landing_pattern");
}

// The first camera may be the one that has failed.
TEST(RosResultsTest, TrackAndUavAreThoseOfAllCameras) {
  TwoCameras cameras;
  cameras.first->topics.clear();
  cameras.Publish(1);
  EXPECT_THAT(cameras.first->topics, ElementsAre(ResultTopic::kTransforms, ResultTopic::kTrack));
  cameras.first->topics.clear();
  cameras.Publish(0);  // at the same time
  EXPECT_THAT(cameras.first->topics, ElementsAre(ResultTopic::kDetections, ResultTopic::kTargetPose,
                                                 ResultTopic::kTransforms, ResultTopic::kTrack));
  const auto pattern = cameras.first->Newest<TfMessage>(ResultTopic::kTransforms).transforms;
  EXPECT_EQ(pattern.at(0).child_frame_id, "landing_pattern");
}

TEST(RosResultsTest, MountsOfAllCamerasAreOneKeptMessage) {
  const TwoCameras cameras;
  const auto mounts = cameras.first->Newest<TfMessage>(ResultTopic::kStaticTransforms).transforms;
  ASSERT_EQ(mounts.size(), 2u);
  EXPECT_EQ(mounts[0].child_frame_id, "camera");
  EXPECT_EQ(mounts[1].header.frame_id, "base_link");
  EXPECT_EQ(mounts[1].child_frame_id, "cam1_optical_frame");
  EXPECT_EQ(mounts[1].transform.translation.x, 0.3);
}

}  // namespace
}  // namespace kestrel
