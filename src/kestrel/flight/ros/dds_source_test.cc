// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/dds_source.h"

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros/test_ros2_system.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// Publishes an image of a kind that no pipeline takes, again and again, until it is destroyed.
class DeepImages {
 public:
  DeepImages(Ros2Node* node, const std::string& topic)
      : node_(node), topic_(node->Advertise(topic, ImageMessage::kType, kLatchedQos)) {
    thread_ = std::thread([this] {
      while (!is_over_) {
        Publish();
        std::this_thread::sleep_for(std::chrono::milliseconds(10));  // the camera's pace
      }
    });
  }
  ~DeepImages() {
    is_over_ = true;
    thread_.join();
  }
  DeepImages(const DeepImages&) = delete;
  DeepImages& operator=(const DeepImages&) = delete;

 private:
  void Publish() {
    ImageMessage image;
    image.header = {0, RosTime(), "camera"};
    image.height = image.width = 1;
    image.step = 2;
    image.encoding = "16UC1";
    image.data = "ab";
    node_->Publish(topic_, CdrBytesOf(image));
  }

  Ros2Node* node_;
  std::size_t topic_;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

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
  const DeepImages deep(&node, "/deep");
  EXPECT_THAT(ErrorOf(domain, "dds:/nothing"), HasSubstr("dds:/nothing: no publisher"));
  EXPECT_THAT(ErrorOf(domain, "dds:/still"), HasSubstr("dds:/still: no images received"));
  EXPECT_THAT(ErrorOf(domain, "dds:/deep"), HasSubstr("16UC1"));
}

}  // namespace
}  // namespace kestrel
