// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "kestrel/bags/mcap_file.h"
#include "kestrel/base/time.h"
#include "kestrel/foxglove/protobuf_schema.h"
#include "kestrel/foxglove/protobuf_writer.h"

namespace kestrel {

// An MCAP file of messages in protobuf, each topic with its schema. It has its own name from the
// beginning, and all that is older than a second is in it: cut off, it is read up to the cut. All
// calls throw InputError when it cannot be written.
class FoxgloveFile {
 public:
  // The file must not be there unless 'replace' is set.
  FoxgloveFile(const std::string& path, bool replace)
      : file_(path, {.replace = replace, .name = UnfinishedName::kOwn}) {}

  // All messages of a topic are of one type.
  template <ProtobufMessage Message>
  void Write(std::string_view topic, Time time, const Message& message) {
    const std::size_t channel = ChannelOf(topic, Message::kType, ProtobufSchemaOf<Message>);
    file_.Write(channel, time, ProtobufBytesOf(message));
  }

  // Writes what waits for more of its second.
  void Flush() { file_.FinishChunk(); }

  // Nothing is written after it.
  void Close() { file_.Close(); }

 private:
  std::size_t ChannelOf(std::string_view topic, std::string_view type, std::string (*schema)());

  McapFile file_;
  std::map<std::string, std::size_t, std::less<>> channels_;  // by topic
};

}  // namespace kestrel
