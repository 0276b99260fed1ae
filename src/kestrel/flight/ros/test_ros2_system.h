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

// A system of ROS 2 with cameras over the landing pattern, until it is destroyed. Each publishes
// the frames of a recording again and again, ten per second and stamped with the present time.
class RosSystem {
 public:
  RosSystem(int domain, const std::string& flight,
            const std::vector<std::string>& cameras = {"camera"})
      : node_(domain, {"system"}) {
    const auto source = OpenSource({flight}, PixelFormat::kGray);
    for (Frame frame; source->Next(&frame);) frames_.push_back(frame);
    poses_ = source->poses();
    calibration_ = *source->calibration();
    for (const std::string& name : cameras) {
      cameras_.push_back(
          {name, node_.Advertise("/" + name + "/image_raw", ImageMessage::kType, kSensorDataQos),
           node_.Advertise("/" + name + "/camera_info", CameraInfoMessage::kType, kSensorDataQos)});
    }
    odometry_ = node_.Advertise("/odom", OdometryMessage::kType, kDefaultQos);
    PublishMounts();
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
  struct Camera {
    std::string frame;
    std::size_t image = 0, info = 0;  // publishers
  };

  void PublishMounts() {
    TfMessage mounts;
    for (const Camera& camera : cameras_) {
      TransformStampedMessage& transform = mounts.transforms.emplace_back();
      transform.header.frame_id = "base_link";
      transform.child_frame_id = camera.frame;
      transform.transform = TransformMessageOf(*calibration_.body_from_camera);
    }
    node_.Publish(node_.Advertise("/tf_static", TfMessage::kType, kLatchedQos), CdrBytesOf(mounts));
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
    for (const Camera& camera : cameras_) Publish(camera, frame.image, stamp);
  }

  void Publish(const Camera& camera, const cv::Mat& pixels, Time stamp) {
    CameraInfoMessage info = CameraInfoOf(calibration_.intrinsics);
    info.header = {0, stamp, camera.frame};
    node_.Publish(camera.info, CdrBytesOf(info));
    ImageMessage image;
    image.header = {0, stamp, camera.frame};
    image.height = static_cast<std::uint32_t>(pixels.rows);
    image.width = image.step = static_cast<std::uint32_t>(pixels.cols);
    image.encoding = "mono8";
    image.data = {reinterpret_cast<const char*>(pixels.data), pixels.total()};
    node_.Publish(camera.image, CdrBytesOf(image));
  }

  Ros2Node node_;
  std::vector<Frame> frames_;
  std::vector<PoseSample> poses_;
  CameraCalibration calibration_;
  std::vector<Camera> cameras_;
  std::size_t odometry_ = 0;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

}  // namespace kestrel
