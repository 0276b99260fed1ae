// SPDX-License-Identifier: BSD-3-Clause
// Usage: bag_read messages|frames BAG. Reads all of a bag, for scripts/bag_cost: each message as
// bytes in the caller's memory, or each frame, with everything that Kestrel reads from a bag before
// the first frame. Prints their number and the processor time in seconds.
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/bag_source.h"
#include "kestrel/io/bags/open_bag.h"

namespace kestrel {
namespace {

std::size_t ReadMessages(const std::string& path) {
  const auto bag = OpenBag(path);
  std::vector<std::size_t> topics(bag->topics().size());
  std::iota(topics.begin(), topics.end(), 0);
  bag->Select(topics);
  std::size_t count = 0;
  std::string bytes;
  for (BagMessage message; bag->Next(&message); ++count) bytes = message.data;
  return count;
}

std::size_t ReadFrames(const std::string& path) {
  BagSource source(path, {});
  std::size_t count = 0;
  for (Frame frame; source.Next(&frame);) ++count;
  return count;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  const std::string_view what = argc == 3 ? argv[1] : "";
  if (what != "messages" && what != "frames") {
    std::fputs("usage: bag_read messages|frames BAG\n", stderr);
    return 2;
  }
  try {
    const auto read = what == "frames" ? kestrel::ReadFrames : kestrel::ReadMessages;
    const std::clock_t start = std::clock();
    const std::size_t count = read(argv[2]);
    std::printf("%zu %.3f\n", count, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  } catch (const kestrel::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
