// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kestrel {

// The files of a rosbag2 folder.
struct BagFolder {
  std::vector<std::string> files;        // one after the other
  bool has_compressed_messages = false;  // each by zstd
};

// Whether rosbag2 has compressed the file as a whole (.db3.zstd, .mcap.zstd), which is not read.
bool IsCompressedBagFile(const std::filesystem::path& file);

// Whether the folder is a bag of rosbag2: with its metadata.yaml, or with .db3 or .mcap files,
// compressed ones too.
bool IsBagFolder(const std::filesystem::path& folder);

// By metadata.yaml; without it, as a power loss leaves it, all .db3 or .mcap files in natural
// order. Throws InputError when a file is missing, or metadata.yaml is at fault.
BagFolder ReadBagFolder(const std::filesystem::path& folder);

}  // namespace kestrel
