// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "kestrel/io/bags/bag_reader.h"

namespace kestrel {

// Whether the argument is a bag: a file that begins as one, or is called .bag, .mcap or .db3; a
// folder with metadata.yaml of rosbag2, or with such files.
bool IsBag(const std::string& path);

// The reader for it. Throws InputError with what is wrong with it.
std::unique_ptr<BagReader> OpenBag(const std::string& path);

}  // namespace kestrel
