// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/foxglove/foxglove_file.h"

namespace kestrel {

std::size_t FoxgloveFile::ChannelOf(std::string_view topic, std::string_view type,
                                    std::string (*schema)()) {
  const auto known = channels_.find(topic);
  if (known != channels_.end()) return known->second;
  const std::size_t channel = file_.AddChannel({.topic = std::string(topic),
                                                .message_encoding = "protobuf",
                                                .schema_name = std::string(type),
                                                .schema_encoding = "protobuf",
                                                .schema = schema()});
  channels_.emplace(topic, channel);
  return channel;
}

}  // namespace kestrel
