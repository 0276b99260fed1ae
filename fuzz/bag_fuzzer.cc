// SPDX-License-Identifier: BSD-3-Clause
// For any content of a bag's file, its readers give messages of topics that they listed, and frames
// in order of time, or refuse the bag. As for any file, the content tells the kind of bag.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/bag_source.h"
#include "kestrel/io/bags/open_bag.h"

namespace {

// One file for all inputs, in memory if possible.
const std::string& InputFile() {
  static const std::string kFile = [] {
    const std::filesystem::path memory = "/dev/shm";
    const auto folder =
        std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    return (folder / ("bag_fuzzer_" + std::to_string(getpid()))).string();
  }();
  return kFile;
}

void ReadMessages() {
  const auto bag = kestrel::OpenBag(InputFile());
  std::vector<std::size_t> all(bag->topics().size());
  std::iota(all.begin(), all.end(), 0);
  bag->Select(all);
  for (kestrel::BagMessage message; bag->Next(&message);) {
    if (message.topic >= all.size()) std::abort();
  }
}

void ReadFrames() {
  kestrel::BagSource source(InputFile(), {});
  std::optional<kestrel::Time> last;
  for (kestrel::Frame frame; source.Next(&frame);) {
    if (frame.image.empty() || (last && frame.time <= *last)) std::abort();
    last = frame.time;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::ofstream(InputFile(), std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  for (const auto read : {ReadMessages, ReadFrames}) {
    try {
      read();
    } catch (const kestrel::InputError&) {
    }
  }
  return 0;
}
