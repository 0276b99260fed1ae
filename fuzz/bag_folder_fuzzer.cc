// SPDX-License-Identifier: BSD-3-Clause
// For any metadata.yaml, a folder of rosbag2 has files that exist, or is refused.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/bag_folder.h"

namespace {

namespace fs = std::filesystem;

// One folder for all inputs, in memory if possible; it contains one file of a bag.
const fs::path& InputFolder() {
  static const fs::path kFolder = [] {
    const fs::path memory = "/dev/shm";
    const fs::path folder = (fs::exists(memory) ? memory : fs::temp_directory_path()) /
                            ("bag_folder_fuzzer_" + std::to_string(getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "flight_0.mcap") << "";
    return folder;
  }();
  return kFolder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::ofstream(InputFolder() / "metadata.yaml", std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  if (!kestrel::IsBagFolder(InputFolder())) std::abort();
  try {
    const kestrel::BagFolder folder = kestrel::ReadBagFolder(InputFolder());
    if (folder.files.empty()) std::abort();
    for (const std::string& file : folder.files) {
      if (!fs::is_regular_file(file)) std::abort();
    }
  } catch (const kestrel::InputError&) {
  }
  return 0;
}
