// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/ros/result_connection.h"

namespace kestrel {

// The node's way to ROS. All calls from any thread.
class NodeConnection : public ResultConnection {
 public:
  virtual void Warn(const std::string& text) = 0;
  // On the clock of the stamps.
  virtual Time StampNow() const = 0;
};

}  // namespace kestrel
