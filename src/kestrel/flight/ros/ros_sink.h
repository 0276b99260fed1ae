// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "kestrel/flight/ros/ros_results.h"
#include "kestrel/flight/session/asynchronous_sink.h"

namespace kestrel {

// Returns a sink that publishes on ROS topics. Its thread calls 'notify' with the number of frames
// that are left out because the network is too slow, or why nothing is published any more. The
// flight's state is published once a second.
std::unique_ptr<AsynchronousSink> MakeRosSink(std::shared_ptr<RosResults> results,
                                              std::function<void(const std::string&)> notify);

// Returns a sink that publishes in the caller's thread and leaves nothing out; for sessions over
// recordings. Waits up to a second for subscribers, as the frames of a recording do not wait for
// them.
std::unique_ptr<ObservationSink> MakeWaitingRosSink(std::unique_ptr<RosResults> results);

}  // namespace kestrel
