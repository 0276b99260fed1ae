// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/dds_source.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/onboard/open_live_source.h"
#include "kestrel/flight/ros/test_ros2_system.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Publishes again and again, until it is destroyed.
class Publishing {
 public:
  explicit Publishing(std::function<void()> publish) {
    thread_ = std::thread([this, publish = std::move(publish)] {
      while (!is_over_) {
        publish();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));  // the camera's pace
      }
    });
  }
  ~Publishing() {
    is_over_ = true;
    thread_.join();
  }
  Publishing(const Publishing&) = delete;
  Publishing& operator=(const Publishing&) = delete;

 private:
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

ImageMessage Image(const std::string& frame, const std::string& encoding, std::uint32_t width,
                   std::string_view pixels) {
  ImageMessage image;
  image.header = {0, RosTime(), frame};
  image.height = 1;
  image.width = width;
  image.step = static_cast<std::uint32_t>(pixels.size());
  image.encoding = encoding;
  image.data = pixels;
  return image;
}

// An image of a kind that no pipeline takes.
ImageMessage DeepImage() { return Image("camera", "16UC1", 1, "ab"); }

// The error of opening the source; empty without one.
std::string ErrorOf(int domain, const std::string& uri) {
  DdsOptions options;
  options.wait_s = 0.5;
  DdsSource source(
      options, [&] { return std::make_shared<Ros2Node>(domain, Ros2NodeOptions{"kestrel"}); },
      [](const std::string&) {});
  try {
    source.Scheme().open({.recording = {.sources = {uri}}});
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(DdsSource, ReportsMissingTopics) {
  if (!Ros2Node::Knows(ImageMessage::kType)) GTEST_SKIP() << "no DDS";
  const int domain = TestDomain();
  Ros2Node node(domain, {"publisher"});
  node.Advertise("/still", ImageMessage::kType, kLatchedQos);
  const std::size_t deep = node.Advertise("/deep", ImageMessage::kType, kLatchedQos);
  const Publishing images([&] { node.Publish(deep, CdrBytesOf(DeepImage())); });
  EXPECT_THAT(ErrorOf(domain, "dds:/nothing"), HasSubstr("dds:/nothing: no publisher"));
  EXPECT_THAT(ErrorOf(domain, "dds:/still"), HasSubstr("dds:/still: no images received"));
  EXPECT_THAT(ErrorOf(domain, "dds:/deep"), HasSubstr("16UC1"));
}

// A system with the poses of a UAV, and two cameras at its nose and tail.
class NoseAndTail {
 public:
  // 'infos': the cameras that publish camera_info.
  NoseAndTail(int domain, const std::vector<std::string>& infos) : node_(domain, {"system"}) {
    const std::size_t odometry = node_.Advertise("/odom", OdometryMessage::kType, kDefaultQos);
    PublishMounts();
    std::vector<std::size_t> images, lenses;
    for (const std::string& name : kNames) {
      images.push_back(
          node_.Advertise("/" + name + "/image_raw", ImageMessage::kType, kSensorDataQos));
    }
    for (const std::string& name : infos) {
      lenses.push_back(
          node_.Advertise("/" + name + "/camera_info", CameraInfoMessage::kType, kSensorDataQos));
    }
    publishing_.emplace([this, odometry, images, lenses] {
      OdometryMessage pose;
      pose.header = {0, RosTime(), "odom"};
      pose.child_frame_id = "uav";
      node_.Publish(odometry, CdrBytesOf(pose));
      for (std::size_t i = 0; i < lenses.size(); ++i) {
        const CameraIntrinsics lens{.width_px = i == 0 ? 2 : 4,
                                    .height_px = 1,
                                    .fx_px = 2,
                                    .fy_px = 2,
                                    .cx_px = 0,
                                    .cy_px = 0,
                                    .distortion = {}};
        node_.Publish(lenses[i], CdrBytesOf(CameraInfoOf(lens)));
      }
      node_.Publish(images[0], CdrBytesOf(Image("nose_lens", "mono8", 2, "ab")));
      node_.Publish(images[1], CdrBytesOf(Image("tail_lens", "mono8", 4, "abcd")));
    });
  }

 private:
  static inline const std::vector<std::string> kNames = {"nose", "tail"};

  void PublishMounts() {
    TfMessage mounts;
    for (const double x : {0.2, -0.2}) {
      TransformStampedMessage& mount = mounts.transforms.emplace_back();
      mount.header.frame_id = "uav";
      mount.child_frame_id = x > 0 ? "nose_lens" : "tail_lens";
      mount.transform.translation.x = x;
    }
    node_.Publish(node_.Advertise("/tf_static", TfMessage::kType, kLatchedQos), CdrBytesOf(mounts));
  }

  Ros2Node node_;
  std::optional<Publishing> publishing_;
};

class DdsSourceOfTwoTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Ros2Node::Knows(ImageMessage::kType)) GTEST_SKIP() << "no DDS";
  }

  OpenedLiveSource Open(const std::vector<std::string>& uris) {
    std::vector<RecordingChoice> cameras;
    for (const std::string& uri : uris) cameras.push_back({.sources = {uri}});
    return OpenLiveCameras(cameras, {}, [this](const std::string& fault) { reported_ += fault; },
                           {source_.Scheme()});
  }

  static DdsOptions Options() {
    DdsOptions options;
    options.wait_s = 2;
    return options;
  }

  int domain_ = TestDomain();
  std::string reported_;
  DdsSource source_{
      Options(), [this] { return std::make_shared<Ros2Node>(domain_, Ros2NodeOptions{"kestrel"}); },
      [this](const std::string& text) { reported_ += text; }};
};

TEST_F(DdsSourceOfTwoTest, HasEachCameraAndThePosesOnce) {
  const NoseAndTail system(domain_, {"nose", "tail"});
  const OpenedLiveSource opened = Open({"dds:/nose/image_raw", "dds:/tail/image_raw"});
  EXPECT_EQ(reported_, "");
  ASSERT_EQ(opened.further.size(), 1u);
  const CameraCalibration& tail = opened.further.front();
  EXPECT_EQ(tail.name, "cam1");
  EXPECT_EQ(tail.intrinsics.width_px, 4);
  EXPECT_EQ(tail.body_from_camera.value().translation.x(), -0.2);
  EXPECT_EQ(opened.calibration.body_from_camera.value().translation.x(), 0.2);
  EXPECT_TRUE(opened.has_poses);
  EXPECT_EQ(source_.frames()->camera, "nose_lens");
  EXPECT_THAT(source_.frames()->further, ElementsAre("tail_lens"));
  std::vector<int> frames(2);
  Time before = Time::min();
  while (frames[0] < 5 || frames[1] < 5) {
    const auto event = opened.source->Next(std::chrono::seconds(5));
    ASSERT_TRUE(event) << opened.source->error();
    if (const auto* frame = std::get_if<Frame>(&*event)) {
      ++frames[frame->camera];
      EXPECT_EQ(frame->image.cols, frame->camera == 0 ? 2 : 4);
    } else if (const auto* pose = std::get_if<PoseSample>(&*event)) {
      EXPECT_GT(pose->time, before);
      before = pose->time;
    }
  }
  EXPECT_GT(before, Time::min());
}

TEST_F(DdsSourceOfTwoTest, LeavesOutCameraThatIsNotThere) {
  const NoseAndTail system(domain_, {"nose", "tail"});
  const OpenedLiveSource opened = Open({"dds:/nowhere", "dds:/tail/image_raw"});
  EXPECT_THAT(reported_, HasSubstr("cam0: dds:/nowhere: no publisher"));
  EXPECT_EQ(opened.calibration.name, "cam1");
  EXPECT_TRUE(opened.has_poses);
  EXPECT_EQ(source_.frames()->camera, "tail_lens");
}

TEST_F(DdsSourceOfTwoTest, GivesNoCameraTheLensOfAnother) {
  const NoseAndTail system(domain_, {"nose"});
  const OpenedLiveSource opened = Open({"dds:/nose/image_raw", "dds:/tail/image_raw"});
  EXPECT_THAT(reported_, HasSubstr("cam1: dds:/tail/image_raw: /nose/camera_info is of another"));
  EXPECT_TRUE(opened.further.empty());
}

}  // namespace
}  // namespace kestrel
