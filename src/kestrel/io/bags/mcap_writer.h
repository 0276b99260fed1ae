// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "kestrel/io/bags/bag_writer.h"
#include "kestrel/io/bags/mcap_file.h"

namespace kestrel {

// Writes a bag of ROS 2 as an MCAP file.
class McapWriter : public BagWriter {
 public:
  McapWriter(const std::string& path, Compression compression, bool replace)
      : file_(path, {.profile = "ros2", .compression = compression, .replace = replace}) {}

  WireFormat format() const override { return WireFormat::kCdr; }
  std::size_t AddTopic(const std::string& name, std::string_view type, bool is_latched) override;
  void Write(std::size_t topic, Time time, std::string_view data) override {
    file_.Write(topic, time, data);
  }
  void Close() override { file_.Close(); }

 private:
  McapFile file_;
};

}  // namespace kestrel
