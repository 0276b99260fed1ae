// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>

#include "kestrel/app/foxglove/foxglove_sink.h"
#include "kestrel/io/bags/mcap_file.h"

namespace kestrel {

// An MCAP file of messages in protobuf, each topic with its schema. It has its own name from the
// beginning, and all that is older than a second is in it: cut off, it is read up to the cut. All
// calls throw InputError when it cannot be written.
class FoxgloveFile : public FoxgloveSink {
 public:
  // The file must not be there unless 'replace' is set.
  FoxgloveFile(const std::string& path, bool replace)
      : file_(path, {.replace = replace, .name = UnfinishedName::kOwn}) {}

  // Whether nothing was written.
  bool empty() const { return channels_.empty(); }

  // Writes what waits for more of its second.
  void Flush() { file_.FinishChunk(); }

  // Nothing is written after it.
  void Close() { file_.Close(); }

 private:
  void Put(const FoxgloveTopicInfo& topic, Time time, std::string message) override;
  std::size_t ChannelOf(const FoxgloveTopicInfo& topic);

  McapFile file_;
  std::map<std::string, std::size_t, std::less<>> channels_;  // by topic
};

}  // namespace kestrel
