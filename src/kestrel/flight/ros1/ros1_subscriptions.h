// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "kestrel/flight/ros1/ros1_connection.h"
#include "kestrel/io/bags/bag_reader.h"

namespace kestrel {

// The topics of a camera and of the UAV's pose, before they are remapped.
struct Ros1SourceTopics {
  std::string image = "image";  // camera_info lies beside it, as in image_transport
  bool is_compressed = false;   // the images are on image/compressed
  bool has_transforms = false;  // tf, for the mount or for the poses
  std::string poses;            // of any type with a pose; empty: none
};

// Subscribes to the topics. The thread of Spin calls 'take' for each message, as TopicSource takes
// it; compressed images have the topic of the raw ones.
void SubscribeTo(const Ros1SourceTopics& topics, Ros1Connection* ros,
                 const std::function<void(const BagTopic&, const std::string& bytes)>& take);

}  // namespace kestrel
