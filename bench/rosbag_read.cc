// SPDX-License-Identifier: BSD-3-Clause
// Usage: rosbag_read BAG. Reads messages like bag_read, but with rosbag's library and in the way of
// `rosbag play`: each message as bytes in the caller's memory. Prints the same.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::clock_t start = std::clock();
  rosbag::Bag bag(argv[1]);
  rosbag::View view(bag);
  std::size_t count = 0;
  std::vector<std::uint8_t> bytes;
  for (const rosbag::MessageInstance& message : view) {
    bytes.resize(message.size());
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    ++count;
  }
  std::printf("%zu %.3f\n", count, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
}
