// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/io/recording/open_source.h"
#include "kestrel/io/ros_messages/camera_info.h"
#include "kestrel/io/ros_messages/frame_tree.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {

template <class Message>
std::string CdrBytesOf(const Message& message) {
  return SerializeMessage(message, WireFormat::kCdr);
}

// The present time on the clock of ROS.
inline Time RosTime() {
  return Time(
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch()));
}

// Receives some of the topics of a node called kestrel until it is destroyed.
class RosListener {
 public:
  RosListener(int domain, const std::vector<std::pair<std::string, std::string_view>>& topics)
      : node_(domain, {"listener"}) {
    for (const auto& [name, type] : topics) {
      names_.push_back(name);
      node_.Subscribe(name, type, kDefaultQos);
    }
    thread_ = std::thread([this] {
      while (!is_over_) {
        node_.Take(std::chrono::milliseconds(10), [this](std::size_t i, std::string_view bytes) {
          heard_[names_[i]].emplace_back(bytes);
        });
      }
    });
  }
  ~RosListener() { Stop(); }
  RosListener(const RosListener&) = delete;
  RosListener& operator=(const RosListener&) = delete;

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
        std::this_thread::sleep_for(std::chrono::milliseconds(100));  // the camera's pace
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
    transform.transform = TransformMessageOf(*calibration_.body_from_camera);
    node_.Publish(node_.Advertise("/tf_static", TfMessage::kType, kLatchedQos), CdrBytesOf(mount));
  }

  void Publish(const Frame& frame) {
    const Time stamp = RosTime();
    const auto pose = std::find_if(poses_.begin(), poses_.end(), [&](const PoseSample& sample) {
      return sample.time >= frame.time;
    });
    OdometryMessage odometry;
    odometry.header = {0, stamp, "odom"};
    odometry.child_frame_id = "base_link";
    odometry.pose.pose = PoseMessageOf(pose->world_from_body);
    node_.Publish(odometry_, CdrBytesOf(odometry));
    CameraInfoMessage info = CameraInfoOf(calibration_.intrinsics);
    info.header = {0, stamp, "camera"};
    node_.Publish(info_, CdrBytesOf(info));
    ImageMessage image;
    image.header = {0, stamp, "camera"};
    image.height = static_cast<std::uint32_t>(frame.image.rows);
    image.width = image.step = static_cast<std::uint32_t>(frame.image.cols);
    image.encoding = "mono8";
    image.data = {reinterpret_cast<const char*>(frame.image.data), frame.image.total()};
    node_.Publish(image_, CdrBytesOf(image));
  }

  Ros2Node node_;
  std::vector<Frame> frames_;
  std::vector<PoseSample> poses_;
  CameraCalibration calibration_;
  std::size_t image_ = 0, info_ = 0, odometry_ = 0;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

}  // namespace kestrel
