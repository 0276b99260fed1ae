// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/core/base/shown.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// How the messages of a topic are serialized.
enum class WireFormat {
  kRos1,   // ROS 1
  kCdr,    // ROS 2: XCDR1 after four bytes that say so
  kOther,  // JSON, Protobuf, ...: not read
};

// What a bag has of one name and type.
struct BagTopic {
  std::string name;  // "/camera/image_raw"
  std::string type;  // "sensor_msgs/Image", of ROS 2 too
  WireFormat wire_format = WireFormat::kOther;
  std::optional<std::uint64_t> messages;  // where the bag tells
};

struct BagMessage {
  std::size_t topic = 0;  // of BagReader::topics()
  Time arrival;           // when it was recorded
  std::string_view data;  // serialized; valid until the next message is read
};

// Messages of a bag, one after the other as they were recorded. It takes the memory of one chunk
// (or file row), whatever the bag's size.
class BagReader {
 public:
  virtual ~BagReader() = default;

  // What is in the bag; it stays the same.
  virtual const std::vector<BagTopic>& topics() const = 0;

  // From the start: only the messages of these topics (indices, in order).
  virtual void Select(const std::vector<std::size_t>& topics) = 0;

  // False at the end. Throws InputError when the bag is broken here. Before Select there is none.
  virtual bool Next(BagMessage* message) = 0;

  // What the user should know of the bag, on one line: that it was cut off and where; else empty.
  virtual std::string remark() const { return ""; }

  // What was left out so far because it is damaged, on one line; else empty.
  virtual std::string damage() const { return ""; }
};

// The type by the one name that it has here: "sensor_msgs/msg/Image" is "sensor_msgs/Image".
std::string NormalTypeName(std::string_view type);

// A topic's or type's name as it was read, fit for messages and results: what ROS allows in names
// stays as it is, what would break a line does not.
inline std::string PlainTopicName(std::string_view name) {
  constexpr std::size_t kMaxLength = 256;
  return Shown(name, kMaxLength);
}

}  // namespace kestrel
