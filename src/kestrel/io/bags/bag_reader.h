// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

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
  virtual const std::vector<RosTopic>& topics() const = 0;

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

}  // namespace kestrel
