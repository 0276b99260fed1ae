// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

// Indices of the topics that a bag is read for.
struct TopicChoice {
  std::size_t image = 0;
  std::optional<std::size_t> camera_info;
  std::optional<std::size_t> pose;      // nothing: tf has the poses
  std::vector<std::size_t> transforms;  // tf and static tf
};

// Finds the topics by type, and by 'names' (of --topic) where the type is ambiguous. Of several
// cameras one must be named, and of several topics with poses too, unless one of them is the local
// position from mavros. Of an image that exists raw and compressed the raw one is taken. The
// camera_info is the one beside the image, or the only one. Throws InputError with 'bag' and its
// topics when there is no image or the choice is ambiguous.
TopicChoice ChooseTopics(const std::vector<RosTopic>& topics, const std::vector<std::string>& names,
                         const std::string& bag);

// True when the topic's name (image_rect) shows that image_proc has undistorted its images.
bool IsRectified(const std::string& topic);

}  // namespace kestrel
