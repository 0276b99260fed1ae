// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "kestrel/io/bags/bag_reader.h"

namespace kestrel {

// True when the argument is a bag: a file with a bag's first bytes or the extension .bag, .mcap or
// .db3, or a folder with metadata.yaml of rosbag2 or with such files.
bool IsBag(const std::string& path);

// Returns a reader for the bag. Throws InputError with its fault.
std::unique_ptr<BagReader> OpenBag(const std::string& path);

}  // namespace kestrel
