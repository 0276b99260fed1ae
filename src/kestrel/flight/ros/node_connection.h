// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/ros/result_connection.h"

namespace kestrel {

// The node's connection to ROS. Any thread may call all functions.
class NodeConnection : public ResultConnection {
 public:
  virtual void Warn(const std::string& text) = 0;
  // Returns the present time on the clock of the stamps.
  virtual Time StampNow() const = 0;
};

}  // namespace kestrel
