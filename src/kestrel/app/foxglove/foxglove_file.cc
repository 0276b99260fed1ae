// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/foxglove_file.h"

namespace kestrel {

void FoxgloveFile::Put(const FoxgloveTopicInfo& topic, Time time, std::string message) {
  file_.Write(ChannelOf(topic), time, message);
}

std::size_t FoxgloveFile::ChannelOf(const FoxgloveTopicInfo& topic) {
  const auto known = channels_.find(topic.name);
  if (known != channels_.end()) return known->second;
  const std::size_t channel = file_.AddChannel({.topic = std::string(topic.name),
                                                .message_encoding = "protobuf",
                                                .schema_name = std::string(topic.type),
                                                .schema_encoding = "protobuf",
                                                .schema = topic.schema()});
  channels_.emplace(topic.name, channel);
  return channel;
}

}  // namespace kestrel
