// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kestrel {

// The content of a rosbag2 folder.
struct BagFolder {
  std::vector<std::string> files;        // in the order of recording
  bool has_compressed_messages = false;  // each compressed by zstd
};

// True when rosbag2 has compressed the whole file (.db3.zstd, .mcap.zstd). Such files are not read.
bool IsCompressedBagFile(const std::filesystem::path& file);

// True when the folder is a bag of rosbag2: it has a metadata.yaml, or .db3 or .mcap files, perhaps
// compressed.
bool IsBagFolder(const std::filesystem::path& folder);

// Reads metadata.yaml. Without it, as after a power loss, it takes all .db3 or .mcap files in
// natural order. Throws InputError when a file is missing or metadata.yaml is not valid.
BagFolder ReadBagFolder(const std::filesystem::path& folder);

}  // namespace kestrel
