// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "kestrel/app/cli/test_command.h"
#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/camera_info.h"
#include "kestrel/io/bags/frame_tree.h"
#include "kestrel/io/bags/result_messages.h"
#include "kestrel/io/bags/serialization.h"
#include "kestrel/io/recording/open_source.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr Duration kTick = std::chrono::milliseconds(10);

template <class Message>
std::string BytesOf(const Message& message) {
  return SerializeMessage(message, WireFormat::kCdr);
}

Time RosTime() {
  return Time(
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()));
}

// Receives some of the topics of a node called kestrel until it is destroyed.
class Listener {
 public:
  Listener(int domain, const std::vector<std::pair<std::string, std::string_view>>& topics)
      : node_(domain, {"listener"}) {
    for (const auto& [name, type] : topics) {
      names_.push_back(name);
      node_.Subscribe(name, type, kDefaultQos);
    }
    thread_ = std::thread([this] {
      while (!is_over_) {
        node_.Take(kTick, [this](std::size_t i, std::string_view bytes) {
          heard_[names_[i]].emplace_back(bytes);
        });
      }
    });
  }
  ~Listener() { Stop(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // Ends it and returns the received messages by topic.
  const std::map<std::string, std::vector<std::string>>& Stop() {
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
    return heard_;
  }

 private:
  Ros2Node node_;
  std::vector<std::string> names_;
  std::map<std::string, std::vector<std::string>> heard_;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

class DdsCommandTest : public CommandTest {
 protected:
  // Simulates a flight over the landing pattern. Returns its folder.
  std::string WriteFlight() const {
    const Outcome outcome = Run("simulate landing --scenario calm --seed 2 --output " +
                                folder_ / "flight" + " --set frames=10 --set rate_hz=10" +
                                " --set ground.map_px=256 --set shutter.rays_per_pixel=4");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return folder_ / "flight";
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

TEST_F(DdsCommandTest, LandTellsRos2WhatItFinds) {
  if (!HasDds()) GTEST_SKIP() << "no DDS";
  const std::string flight = WriteFlight();
  Listener listener(domain_, {{"/pad/detections", Detection3DArrayMessage::kType},
                              {"/pad/target_pose", PoseWithCovarianceStampedMessage::kType},
                              {"/pad/track", OdometryMessage::kType},
                              {"/pad/prediction", PathMessage::kType},
                              {"/pad/markers", MarkerArrayMessage::kType},
                              {"/tf", TfMessage::kType}});
  const Outcome outcome = Run(fmt::format("land {} --output {} --dds {} --set dds.node=pad", flight,
                                          folder_ / "out", domain_));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto& heard = listener.Stop();
  ASSERT_EQ(heard.at("/pad/detections").size(), 10u);
  const std::string rows = ReadFile(folder_ / "out/landing_detections.csv");
  for (const std::string& bytes : heard.at("/pad/detections")) {
    const auto message = ParseMessage<Detection3DArrayMessage>(bytes, WireFormat::kCdr, "heard");
    EXPECT_THAT(rows, HasSubstr(fmt::format(",{},1,", ToNanoseconds(message.header.stamp))));
    EXPECT_EQ(message.header.frame_id, "camera_optical_frame");
    EXPECT_EQ(message.detections.size(), 1u);
    EXPECT_EQ(message.detections.at(0).results.at(0).class_id, "landing_pattern");
  }
  EXPECT_EQ(heard.at("/pad/target_pose").size(), 10u);
  EXPECT_EQ(heard.at("/pad/markers").size(), 10u);
  EXPECT_GE(heard.at("/pad/track").size(), 5u);
  EXPECT_EQ(heard.at("/pad/prediction").size(), heard.at("/pad/track").size());
  EXPECT_EQ(heard.at("/tf").size(), 20u);  // the UAV and the pattern
}

// A system of ROS 2 with a camera over the landing pattern, until it is destroyed. It publishes the
// frames of a recording again and again, ten per second and stamped with the present time.
class RosSystem {
 public:
  RosSystem(int domain, const std::string& flight) : node_(domain, {"system"}) {
    const auto source = OpenSource({flight}, PixelFormat::kGray);
    for (Frame frame; source->Next(&frame);) frames_.push_back(frame);
    poses_ = source->poses();
    calibration_ = *source->calibration();
    image_ = node_.Advertise("/camera/image_raw", ImageMessage::kType, kSensorDataQos);
    info_ = node_.Advertise("/camera/camera_info", CameraInfoMessage::kType, kSensorDataQos);
    odometry_ = node_.Advertise("/odom", OdometryMessage::kType, kDefaultQos);
    PublishMount();
    thread_ = std::thread([this] {
      for (std::size_t i = 0; !is_over_; ++i) {
        Publish(frames_[i % frames_.size()]);
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
    });
  }
  ~RosSystem() {
    is_over_ = true;
    thread_.join();
  }
  RosSystem(const RosSystem&) = delete;
  RosSystem& operator=(const RosSystem&) = delete;

 private:
  void PublishMount() {
    TfMessage mount;
    TransformStampedMessage& transform = mount.transforms.emplace_back();
    transform.header.frame_id = "base_link";
    transform.child_frame_id = "camera";
    transform.transform = PoseMessageOf(*calibration_.body_from_camera);
    node_.Publish(node_.Advertise("/tf_static", TfMessage::kType, kLatchedQos), BytesOf(mount));
  }

  void Publish(const Frame& frame) {
    const Time stamp = RosTime();
    const auto pose = std::find_if(poses_.begin(), poses_.end(), [&](const PoseSample& sample) {
      return sample.time >= frame.time;
    });
    OdometryMessage odometry;
    odometry.header = {0, stamp, "odom"};
    odometry.child_frame_id = "base_link";
    odometry.pose = PoseMessageOf(pose->world_from_body);
    node_.Publish(odometry_, BytesOf(odometry));
    CameraInfoMessage info = CameraInfoOf(calibration_.intrinsics);
    info.header = {0, stamp, "camera"};
    node_.Publish(info_, BytesOf(info));
    ImageMessage image;
    image.header = {0, stamp, "camera"};
    image.height = static_cast<std::uint32_t>(frame.image.rows);
    image.width = image.step = static_cast<std::uint32_t>(frame.image.cols);
    image.encoding = "mono8";
    image.data = {reinterpret_cast<const char*>(frame.image.data), frame.image.total()};
    node_.Publish(image_, BytesOf(image));
  }

  Ros2Node node_;
  std::vector<Frame> frames_;
  std::vector<PoseSample> poses_;
  CameraCalibration calibration_;
  std::size_t image_ = 0, info_ = 0, odometry_ = 0;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

TEST_F(DdsCommandTest, FlySeesWhatASystemOfRos2Publishes) {
  if (!HasDds()) GTEST_SKIP() << "no DDS";
  const std::string flight = WriteFlight();
  const RosSystem system(domain_, flight);
  Listener listener(domain_, {{"/kestrel/target_pose", PoseWithCovarianceStampedMessage::kType},
                              {"/kestrel/track", OdometryMessage::kType},
                              {"/diagnostics", DiagnosticArrayMessage::kType}});
  const Time begin = RosTime();
  const int status = std::system(
      fmt::format("timeout -s INT 5 {} fly dds:/camera/image_raw --dds {} --output '{}' 2>'{}'",
                  KESTREL_COMMAND, domain_, folder_ / "out", folder_ / "said")
          .c_str());
  const std::string said = ReadFile(folder_ / "said");
  ASSERT_EQ(WEXITSTATUS(status), 124) << said;  // timeout's own status
  EXPECT_GE(Lines(ReadFile(folder_ / "out/landing_detections.csv")), 11) << said;
  const auto& heard = listener.Stop();
  ASSERT_GE(heard.count("/kestrel/target_pose"), 1u) << said;
  ASSERT_GE(heard.count("/kestrel/track"), 1u) << said;
  ASSERT_GE(heard.count("/diagnostics"), 1u) << said;
  const auto pose = ParseMessage<PoseWithCovarianceStampedMessage>(
      heard.at("/kestrel/target_pose").back(), WireFormat::kCdr, "heard");
  EXPECT_EQ(pose.header.frame_id, "camera");
  EXPECT_GT(pose.header.stamp, begin);
  EXPECT_LT(pose.header.stamp, RosTime());
  const auto track =
      ParseMessage<OdometryMessage>(heard.at("/kestrel/track").back(), WireFormat::kCdr, "heard");
  EXPECT_EQ(track.header.frame_id, "odom");
}

TEST_F(DdsCommandTest, FaultsAreNamed) {
  if (!HasDds()) GTEST_SKIP() << "no DDS";
  Ros2Node node(domain_, {});
  const std::size_t deep = node.Advertise("/deep", ImageMessage::kType, kLatchedQos);
  node.Advertise("/still", ImageMessage::kType, kLatchedQos);
  ImageMessage image;
  image.header = {0, RosTime(), "camera"};
  image.height = image.width = 1;
  image.step = 2;
  image.encoding = "16UC1";
  image.data = "ab";
  std::atomic<bool> is_over = false;
  std::thread publisher([&] {
    while (!is_over) {
      node.Publish(deep, BytesOf(image));
      std::this_thread::sleep_for(kTick);
    }
  });
  const std::string fly = fmt::format("fly --dds {} --set dds.wait_s=0.5 --force dds:", domain_);
  ExpectInputError(fly + "/nothing", "dds:/nothing: nobody publishes that");
  ExpectInputError(fly + "/still", "dds:/still: no image came");
  ExpectInputError(fly + "/deep", "16UC1");
  is_over = true;
  publisher.join();
}

TEST_F(DdsCommandTest, FaultsOfTheArgumentsAreNamedWithAndWithoutDds) {
  ExpectInputError("fly --dds mine --force dds:/deep", "--dds 'mine'");
  ExpectInputError("fly --dds 300 --force dds:/deep", "0 to 232");
  ExpectInputError("land --dds 300 --force nothing", "nothing");
  ExpectInputError("land x --set dds.node=1x", "dds.node");
  ExpectInputError("land x --set dds.distribution=foxy", "dds.distribution");
}

}  // namespace
}  // namespace kestrel
