// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "kestrel/app/ros_node/node_connection.h"
#include "kestrel/app/ros_node/node_files.h"
#include "kestrel/app/ros_node/node_flight.h"
#include "kestrel/app/ros_node/node_options.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/ros/live_transforms.h"
#include "kestrel/io/bags/messages.h"

namespace kestrel {

// A pipeline as a node of ROS 1, without ROS itself: it takes serialized messages and publishes
// through a connection. A message that is not valid is left out with a warning. All functions must
// be called by one thread.
class VisionNode {
 public:
  // 'connection' must outlive this. Throws InputError when a file of the options is not valid.
  VisionNode(const NodeOptions& options, NodeConnection* connection);

  // 'topic': name of the topic for messages and warnings. For images of a topic called image_rect
  // the matrix P of camera_info holds.
  void TakeCameraInfo(std::string_view bytes, const std::string& topic);
  void TakeImage(std::string_view bytes, const std::string& topic);
  void TakeCompressedImage(std::string_view bytes, const std::string& topic);
  void TakePose(std::string_view type, std::string_view bytes, const std::string& topic);
  void TakeTransforms(std::string_view bytes, bool is_static, const std::string& topic);

  // Images are processed between Start and Stop; others are left out.
  void Start() { is_stopped_ = false; }
  void Stop();
  // Discards track, map and counters, and continues with these options; poses, calibration and
  // mount stay. Throws InputError as the constructor does, and then changes nothing.
  void Reset(const NodeOptions& options);
  // Takes over the options that need no reset and keeps track and map. Returns a text that says
  // which options it took over and which not. Throws as Reset does.
  std::string Update(const NodeOptions& options);
  // Returns a text that says what it wrote. Throws InputError when there is no map or it cannot be
  // written.
  std::string SaveMap();

  // To be called once a second. Publishes the map and the diagnostics: rate since the last call,
  // latency and drops since the start or reset.
  void Tick();

 private:
  template <class Message>
  void TakeAnyImage(std::string_view bytes, const std::string& topic);
  template <class Action>
  void WarnOfErrors(const Action& action);
  void Warn(const std::string& text);
  bool CheckOrder(const HeaderMessage& header, const std::string& topic);
  bool StartFlight(const HeaderMessage& header, const std::string& topic);
  std::optional<CameraCalibration> CalibrationFor(const std::string& camera_frame,
                                                  const std::string& topic);
  void AddPose(const PoseSample& pose, const std::string& world);
  void RequireChangeable(const NodeOptions& options) const;
  void Forget();
  void PublishDiagnostics();

  NodeOptions options_;
  NodeConnection* connection_;
  NodeFiles files_;
  std::optional<CameraInfoMessage> camera_info_;
  std::string camera_info_topic_;
  LiveTransforms transforms_;
  std::deque<PoseSample> poses_;  // the newest, for a flight that has not begun yet
  std::string world_;
  std::string body_;  // if the poses' topic names it
  std::unique_ptr<NodeFlight> flight_;
  bool is_stopped_ = false;

  std::optional<Time> newest_;  // stamp of the last accepted image
  std::optional<std::uint32_t> sequence_;
  std::uint64_t received_ = 0;
  std::uint64_t missed_ = 0;   // by the sequence numbers of the headers
  std::uint64_t refused_ = 0;  // broken, out of order, or before calibration and poses were known

  std::string last_warning_;
  Time last_warning_time_;
  Time diagnosed_;
  std::uint64_t diagnosed_images_ = 0;
};

}  // namespace kestrel
