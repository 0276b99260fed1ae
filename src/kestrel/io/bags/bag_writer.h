// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "kestrel/core/base/time.h"
#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/bags/decompression.h"

namespace kestrel {

// A new bag. It is written under another name, and gets its own by Close: whoever finds the file
// finds it whole. All calls throw InputError when it cannot be written.
class BagWriter {
 public:
  virtual ~BagWriter() = default;

  // How messages have to be serialized.
  virtual WireFormat format() const = 0;

  // A topic with messages of a type of messages.h; returns its number. 'is_latched': who comes
  // later gets the last message too, as with static transforms.
  virtual std::size_t AddTopic(const std::string& name, std::string_view type,
                               bool is_latched = false) = 0;

  virtual void Write(std::size_t topic, Time time, std::string_view data) = 0;

  // Nothing is written after it. Without it the bag is discarded.
  virtual void Close() = 0;
};

// Whether a bag is what 'path' names by its extension: .bag (ROS 1), .mcap (ROS 2), .db3 (ROS 2).
bool IsBagName(const std::string& path);

// A writer for the bag that 'path' names. 'compression': none, bz2 and lz4 for ROS 1; none, lz4 and
// zstd for MCAP; none for .db3. Throws InputError for another, and when the file is there and
// 'replace' is not set.
std::unique_ptr<BagWriter> NewBag(const std::string& path, Compression compression, bool replace);

}  // namespace kestrel
