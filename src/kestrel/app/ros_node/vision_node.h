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

// A pipeline as a node of ROS 1, without ROS itself: it is given serialized messages and gives such
// to a connection. What is wrong with a message is a warning; the message is left out.
// All calls by one thread.
class VisionNode {
 public:
  // 'connection' must outlive this. Throws InputError when a file of the options is at fault.
  VisionNode(const NodeOptions& options, NodeConnection* connection);

  // 'topic': the name that messages and warnings have for it; images of one called image_rect are
  // described by P of the camera_info.
  void TakeCameraInfo(std::string_view bytes, const std::string& topic);
  void TakeImage(std::string_view bytes, const std::string& topic);
  void TakeCompressedImage(std::string_view bytes, const std::string& topic);
  void TakePose(std::string_view type, std::string_view bytes, const std::string& topic);
  void TakeTransforms(std::string_view bytes, bool is_static, const std::string& topic);

  // Images are processed from the start on until Stop, after which they are left out.
  void Start() { is_stopped_ = false; }
  void Stop();
  // Forgets track, map and all that was counted, and goes on with these options; poses, calibration
  // and mount stay. Throws InputError, and changes nothing, as the constructor does.
  void Reset(const NodeOptions& options);
  // Takes of these options what needs no reset, forgets nothing, and says in words what it took and
  // what it did not. Throws as Reset.
  std::string Update(const NodeOptions& options);
  // Says in words what it wrote. Throws InputError when there is no map or it cannot be written.
  std::string SaveMap();

  // Once a second: the map, and diagnostics: the rate since the last call, latency and drops since
  // the start or reset.
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
  std::deque<PoseSample> poses_;  // the newest, for a flight that is still to begin
  std::string world_;
  std::string body_;  // where the poses' topic tells it
  std::unique_ptr<NodeFlight> flight_;
  bool is_stopped_ = false;

  std::optional<Time> newest_;  // stamp of an image that was taken
  std::optional<std::uint32_t> sequence_;
  std::uint64_t received_ = 0;
  std::uint64_t missed_ = 0;   // by the numbers of the headers
  std::uint64_t refused_ = 0;  // broken, out of order, or before all was known

  std::string last_warning_;
  Time last_warning_time_;
  Time diagnosed_;
  std::uint64_t diagnosed_images_ = 0;
};

}  // namespace kestrel
