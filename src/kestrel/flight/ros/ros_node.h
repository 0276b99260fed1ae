// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/ros/flight_diagnostics.h"
#include "kestrel/flight/ros/node_connection.h"
#include "kestrel/flight/ros/node_options.h"
#include "kestrel/flight/ros/node_session.h"
#include "kestrel/flight/ros/topic_source.h"

namespace kestrel {

// A LiveSession as a node of ROS 1, without ROS itself: it takes serialized messages and publishes
// through a connection. The session begins with the first image for which calibration, mount and
// poses are known. All functions must be called by one thread.
class RosNode {
 public:
  // 'connection' must outlive this. Throws InputError when a file of the options is not valid.
  RosNode(const NodeOptions& options, NodeConnection* connection);

  // Takes a message of a topic of TopicSource; one that is not valid is left out with a warning.
  void Take(const BagTopic& topic, std::string_view bytes);

  // Images are processed between Start and Stop; others are left out.
  void Start() { SetStopped(false); }
  void Stop() { SetStopped(true); }
  // Discards track, map and poses, and continues with these options; calibration and mount stay.
  // Throws InputError as the constructor does, and then changes nothing.
  void Reset(const NodeOptions& options);
  // Takes over the options that need no reset and keeps track and map. Returns a text that says
  // which options it took over and which not. Throws as Reset does.
  std::string Update(const NodeOptions& options);
  // Returns a text that says what it wrote. Throws InputError when there is no map or it cannot be
  // written.
  std::string SaveMap();

  // To be called once a second. Publishes the map and the diagnostics: the rate since the last
  // call, what came since the start, and what was processed since the session began.
  void Tick();

 private:
  void Warn(const std::string& text);
  // Reads the files of the options. Warns of what in them is not used, and of a target that is not
  // advisable.
  NodeFiles ReadFiles(const NodeOptions& options) const;
  void SetStopped(bool is_stopped);
  std::optional<CameraCalibration> Calibration() const;
  std::string Missing(const std::optional<CameraCalibration>& calibration) const;
  void BeginSession(bool says_why_not);
  void Forget();
  void RequireChangeable(const NodeOptions& options) const;

  NodeOptions options_;
  NodeConnection* connection_;
  NodeFiles files_;
  TopicSource source_;
  std::optional<NodeSession> session_;
  bool is_stopped_ = false;
  std::string last_warning_;
  Time last_warning_time_;
  Rate rate_;
};

}  // namespace kestrel
