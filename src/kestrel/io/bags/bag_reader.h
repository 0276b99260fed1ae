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

// Serialization of a topic's messages.
enum class WireFormat {
  kRos1,      // ROS 1
  kCdr,       // ROS 2: XCDR1 after a header of four bytes
  kProtobuf,  // messages of Foxglove, by the types of ROS that they correspond to
  kOther,     // JSON, other messages in protobuf, ...: not read
};

// A name and type of a bag.
struct BagTopic {
  std::string name;  // "/camera/image_raw"
  std::string type;  // "sensor_msgs/Image", for ROS 2 too
  WireFormat wire_format = WireFormat::kOther;
  std::optional<std::uint64_t> messages;  // number of messages, if the bag tells it
};

struct BagMessage {
  std::size_t topic = 0;  // index in BagReader::topics()
  Time arrival;           // when it was recorded
  std::string_view data;  // serialized; valid until the next message is read
};

// Reads the messages of a bag in the order in which they were recorded. It needs the memory of one
// chunk (or row of the file), whatever the bag's size.
class BagReader {
 public:
  virtual ~BagReader() = default;

  // Returns the topics of the bag; they never change.
  virtual const std::vector<BagTopic>& topics() const = 0;

  // Starts from the beginning with only the messages of these topics (indices, in order).
  virtual void Select(const std::vector<std::size_t>& topics) = 0;

  // Returns false at the end, and before Select. Throws InputError when the bag is broken here.
  virtual bool Next(BagMessage* message) = 0;

  // Returns what the user should know about the bag, in one line: that and where it was cut off;
  // else empty.
  virtual std::string remark() const { return ""; }

  // Returns what has been left out so far because it is damaged, in one line; else empty.
  virtual std::string damage() const { return ""; }
};

// Returns the type's name in the form used here: "sensor_msgs/Image" for "sensor_msgs/msg/Image".
std::string NormalTypeName(std::string_view type);

// Returns the name of a topic or type in a form for messages and results: characters that ROS
// allows in names are unchanged, characters that would break a line are replaced.
inline std::string PlainTopicName(std::string_view name) {
  constexpr std::size_t kMaxLength = 256;
  return Shown(name, kMaxLength);
}

}  // namespace kestrel
