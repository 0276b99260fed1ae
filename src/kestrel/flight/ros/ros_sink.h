// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "kestrel/flight/ros/ros_results.h"
#include "kestrel/flight/session/asynchronous_sink.h"

namespace kestrel {

// Returns a sink that publishes on ROS topics. Its thread calls 'tell' with the number of frames
// that are left out because the network is too slow. 'reports': it publishes the flight's state,
// too, once a second; false: somebody else does.
std::unique_ptr<AsynchronousSink> MakeRosSink(std::shared_ptr<RosResults> results,
                                              std::function<void(const std::string&)> tell,
                                              bool reports = true);

}  // namespace kestrel
