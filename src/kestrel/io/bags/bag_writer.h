// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "kestrel/core/base/time.h"
#include "kestrel/io/bags/decompression.h"
#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

// Writes a new bag. It has another name until Close gives it its own: a file with its own name is
// complete. All functions throw InputError when it cannot be written.
class BagWriter {
 public:
  virtual ~BagWriter() = default;

  // Returns the format in which messages must be serialized.
  virtual WireFormat format() const = 0;

  // Adds a topic with messages of a type of messages.h. Returns its index. 'is_latched': later
  // subscribers get the last message too, as for static transforms.
  virtual std::size_t AddTopic(const std::string& name, std::string_view type,
                               bool is_latched = false) = 0;

  virtual void Write(std::size_t topic, Time time, std::string_view data) = 0;

  // Completes the bag; nothing can be written after it. Without Close the bag is discarded.
  virtual void Close() = 0;
};

// True when the extension of 'path' is that of a bag: .bag (ROS 1), .mcap (ROS 2), .db3 (ROS 2).
bool IsBagName(const std::string& path);

// Returns a writer for the bag 'path'. 'compression': none, bz2 and lz4 for ROS 1; none, lz4 and
// zstd for MCAP; none for .db3. Throws InputError for any other, and when the file exists and
// 'replace' is false.
std::unique_ptr<BagWriter> NewBag(const std::string& path, Compression compression, bool replace);

}  // namespace kestrel
