// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/ros_results.h"

#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/camera/paper_camera.h"

namespace kestrel {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

class TopicList : public ResultConnection {
 public:
  bool HasSubscribers(ResultTopic /*topic*/) const override { return false; }
  void Publish(ResultTopic topic, const std::string& /*bytes*/) override {
    topics.push_back(topic);
  }

  std::vector<ResultTopic> topics;
};

// The first camera may be the one that has failed.
TEST(RosResultsTest, TrackIsThatOfAllCameras) {
  const auto connection = std::make_shared<TopicList>();
  CameraCalibration calibration;
  calibration.intrinsics = PaperCamera();
  RosResults results(connection, {}, {.camera = "camera", .world = "map", .body = {}}, calibration,
                     {}, {});
  LandingObservation observation;
  observation.target.emplace();
  Frame frame;
  results.Publish(frame, observation);
  EXPECT_THAT(connection->topics, Contains(ResultTopic::kDetections));
  EXPECT_THAT(connection->topics, Contains(ResultTopic::kTrack));
  connection->topics.clear();
  frame.camera = 1;
  results.Publish(frame, observation);
  EXPECT_THAT(connection->topics, ElementsAre(ResultTopic::kTrack));
}

}  // namespace
}  // namespace kestrel
