// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <string>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros/test_ros2_system.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

class DdsCommandTest : public CommandTest {
 protected:
  // A flight over the landing pattern.
  std::string WriteFlight() const {
    return Simulate("landing", "--scenario calm --seed 2 --set frames=10 --set rate_hz=10");
  }

  bool HasDds() {
    try {
      Ros2Node(domain_, {});
      return true;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("built without DDS: run scripts/install-deps --dds"));
      return false;
    }
  }

  int domain_ = TestDomain();
};

TEST_F(DdsCommandTest, LandPublishesResultsToRos2) {
  if (!HasDds()) GTEST_SKIP() << "no DDS";
  const std::string flight = WriteFlight();
  RosListener listener(domain_, {{"/pad/detections", Detection3DArrayMessage::kType},
                                 {"/pad/target_pose", PoseWithCovarianceStampedMessage::kType},
                                 {"/pad/track", OdometryMessage::kType},
                                 {"/pad/prediction", PathMessage::kType},
                                 {"/pad/markers", MarkerArrayMessage::kType},
                                 {"/tf", TfMessage::kType}});
  Succeed(fmt::format("land {} --output {} --dds {} --set dds.node=pad", flight, folder_ / "out",
                      domain_));
  const auto& heard = listener.Stop();
  ASSERT_EQ(heard.at("/pad/detections").size(), 10u);
  const std::string rows = ReadFile(folder_ / "out/landing_detections.csv");
  for (const std::string& bytes : heard.at("/pad/detections")) {
    const auto message = ParseMessage<Detection3DArrayMessage>(bytes, WireFormat::kCdr, "heard");
    EXPECT_THAT(rows, HasSubstr(fmt::format(",{},1,", ToNanoseconds(message.header.stamp))));
    EXPECT_EQ(message.header.frame_id, "camera_optical_frame");
    EXPECT_EQ(message.detections.size(), 1u);
    EXPECT_EQ(message.detections.at(0).results.at(0).hypothesis.class_id, "landing_pattern");
  }
  EXPECT_EQ(heard.at("/pad/target_pose").size(), 10u);
  EXPECT_EQ(heard.at("/pad/markers").size(), 10u);
  EXPECT_GE(heard.at("/pad/track").size(), 5u);
  EXPECT_EQ(heard.at("/pad/prediction").size(), heard.at("/pad/track").size());
  EXPECT_EQ(heard.at("/tf").size(), 20u);  // the UAV and the pattern
}

TEST_F(DdsCommandTest, FlyReceivesTopicsOfRos2System) {
  if (!HasDds()) GTEST_SKIP() << "no DDS";
  const std::string flight = WriteFlight();
  const RosSystem system(domain_, flight);
  RosListener listener(domain_, {{"/kestrel/target_pose", PoseWithCovarianceStampedMessage::kType},
                                 {"/kestrel/track", OdometryMessage::kType},
                                 {"/diagnostics", DiagnosticArrayMessage::kType}});
  const Time begin = RosTime();
  const int status = std::system(
      fmt::format("timeout -s INT 5 {} fly dds:/camera/image_raw --dds {} --output '{}' 2>'{}'",
                  KESTREL_COMMAND, domain_, folder_ / "out", folder_ / "said")
          .c_str());
  const std::string reported = ReadFile(folder_ / "said");
  ASSERT_EQ(WEXITSTATUS(status), 124) << reported;  // timeout's own status
  EXPECT_GE(Lines(ReadFile(folder_ / "out/landing_detections.csv")), 11) << reported;
  const auto& heard = listener.Stop();
  ASSERT_GE(heard.count("/kestrel/target_pose"), 1u) << reported;
  ASSERT_GE(heard.count("/kestrel/track"), 1u) << reported;
  ASSERT_GE(heard.count("/diagnostics"), 1u) << reported;
  const auto pose = ParseMessage<PoseWithCovarianceStampedMessage>(
      heard.at("/kestrel/target_pose").back(), WireFormat::kCdr, "heard");
  EXPECT_EQ(pose.header.frame_id, "camera");
  EXPECT_GT(pose.header.stamp, begin);
  EXPECT_LT(pose.header.stamp, RosTime());
  const auto track =
      ParseMessage<OdometryMessage>(heard.at("/kestrel/track").back(), WireFormat::kCdr, "heard");
  EXPECT_EQ(track.header.frame_id, "odom");
}

TEST_F(DdsCommandTest, LandPublishesResultsOfFurtherCamera) {
  if (!HasDds()) GTEST_SKIP() << "no DDS";
  const std::string flight =
      Simulate("landing",
               "--scenario calm --seed 2 --set frames=10 --set rate_hz=10 --set second.rate_hz=10 "
               "--set second.fov_deg=60");
  RosListener listener(domain_, {{"/kestrel/detections", Detection3DArrayMessage::kType},
                                 {"/kestrel/cam1/detections", Detection3DArrayMessage::kType}});
  Succeed(fmt::format("land {} --output {} --dds {}", flight, folder_ / "out", domain_));
  const auto& heard = listener.Stop();
  ASSERT_GE(heard.count("/kestrel/cam1/detections"), 1u);
  EXPECT_EQ(heard.at("/kestrel/detections").size(), 10u);
  const auto& detections = heard.at("/kestrel/cam1/detections");
  EXPECT_EQ(detections.size(), Lines(ReadFile(folder_ / "out/landing_detections_cam1.csv")) - 1u);
  const auto seen =
      ParseMessage<Detection3DArrayMessage>(detections.back(), WireFormat::kCdr, "heard");
  EXPECT_EQ(seen.header.frame_id, "cam1_optical_frame");
}

TEST_F(DdsCommandTest, FlyReceivesTwoCamerasOfRos2System) {
  if (!HasDds()) GTEST_SKIP() << "no DDS";
  const RosSystem system(domain_, WriteFlight(), {"camera", "second"});
  RosListener listener(domain_,
                       {{"/kestrel/detections", Detection3DArrayMessage::kType},
                        {"/kestrel/cam1/target_pose", PoseWithCovarianceStampedMessage::kType}});
  const int status = std::system(
      fmt::format("timeout -s INT 7 {} fly dds:/camera/image_raw dds:/second/image_raw --dds {} "
                  "--output '{}' --record '{}' 2>'{}'",
                  KESTREL_COMMAND, domain_, folder_ / "out", folder_ / "flight", folder_ / "said")
          .c_str());
  const std::string reported = ReadFile(folder_ / "said");
  ASSERT_EQ(WEXITSTATUS(status), 124) << reported;  // timeout's own status
  EXPECT_GE(Lines(ReadFile(folder_ / "out/landing_detections.csv")), 11) << reported;
  EXPECT_GE(Lines(ReadFile(folder_ / "out/landing_detections_cam1.csv")), 11) << reported;
  EXPECT_GE(Lines(ReadFile(folder_ / "flight/mav0/cam1/data.csv")), 11) << reported;
  const auto& heard = listener.Stop();
  ASSERT_GE(heard.count("/kestrel/detections"), 1u) << reported;
  ASSERT_GE(heard.count("/kestrel/cam1/target_pose"), 1u) << reported;
  const auto pose = ParseMessage<PoseWithCovarianceStampedMessage>(
      heard.at("/kestrel/cam1/target_pose").back(), WireFormat::kCdr, "heard");
  EXPECT_EQ(pose.header.frame_id, "second");
}

TEST_F(DdsCommandTest, ReportsArgumentFaultsWithAndWithoutDds) {
  ExpectInputError("fly --dds mine --force dds:/deep", "--dds 'mine'");
  ExpectInputError("fly --dds 300 --force dds:/deep", "0 to 232");
  ExpectInputError("fly dds:/wide /dev/video0 --camera wide.yaml --camera narrow.yaml",
                   "/dev/video0: expected dds:..., as the first one");
  ExpectInputError("fly dds:/wide dds:/wide", "dds:/wide: is given twice");
  ExpectInputError("land --dds 300 --force nothing", "nothing");
  ExpectInputError("land x --set dds.node=1x", "dds.node");
  ExpectInputError("land x --set dds.distribution=foxy", "dds.distribution");
}

}  // namespace
}  // namespace kestrel
