// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>

#include "kestrel/app/foxglove/foxglove_sink.h"
#include "kestrel/io/bags/mcap_file.h"

namespace kestrel {

// An MCAP file of messages in protobuf, with a schema for each topic. It has its final name from
// the start and contains all messages older than a second; a file that was cut off can be read up
// to the cut. All functions throw InputError when the file cannot be written.
class FoxgloveFile : public FoxgloveSink {
 public:
  // The file must not exist unless 'replace' is set.
  FoxgloveFile(const std::string& path, bool replace)
      : file_(path, {.replace = replace, .name = UnfinishedName::kOwn}) {}

  // True when nothing has been written.
  bool empty() const { return channels_.empty(); }

  // Writes the messages that still wait for their second to be complete.
  void Flush() { file_.FinishChunk(); }

  // Finishes the file; nothing can be written after it.
  void Close() { file_.Close(); }

 private:
  void Put(const FoxgloveTopicInfo& topic, Time time, std::string message) override;
  std::size_t ChannelOf(const FoxgloveTopicInfo& topic);

  McapFile file_;
  std::map<std::string, std::size_t, std::less<>> channels_;  // by topic
};

}  // namespace kestrel
