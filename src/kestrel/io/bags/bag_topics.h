// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/io/bags/bag_reader.h"

namespace kestrel {

// What a bag is read for; indices of its topics.
struct BagTopics {
  std::size_t image = 0;
  std::optional<std::size_t> camera_info;
  std::optional<std::size_t> pose;      // nothing: from tf
  std::vector<std::size_t> transforms;  // tf and static tf
};

// Finds the topics by type, and by 'names' (of --topic) where the type is not enough. Of several
// cameras one must be named, of several topics with poses as well, unless one is what mavros says
// of its local position; of an image that is there raw and compressed the raw one is taken. The
// camera's information is what lies beside the image, or the only one there is. Throws InputError,
// with the 'bag' and the topics that there are, when there is no image or no telling which.
BagTopics ChooseTopics(const std::vector<BagTopic>& topics, const std::vector<std::string>& names,
                       const std::string& bag);

// Whether the images of this topic are called undistorted, as image_proc calls them (image_rect).
bool IsRectified(const std::string& topic);

}  // namespace kestrel
