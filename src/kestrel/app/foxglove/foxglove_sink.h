// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "kestrel/app/foxglove/protobuf_schema.h"
#include "kestrel/app/foxglove/protobuf_writer.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// A topic and the type of all its messages.
template <ProtobufMessage Message>
struct FoxgloveTopic {
  std::string_view name;
};

// The same without the type as a template argument.
struct FoxgloveTopicInfo {
  std::string_view name;
  std::string_view type;    // as "foxglove.Log"
  std::string (*schema)();  // a FileDescriptorSet, serialized
};
template <ProtobufMessage Message>
constexpr FoxgloveTopicInfo InfoOf(const FoxgloveTopic<Message>& topic) {
  return {topic.name, Message::kType, ProtobufSchemaOf<Message>};
}

// Destination of messages in protobuf: a file, or viewers.
class FoxgloveSink {
 public:
  virtual ~FoxgloveSink() = default;

  // Throws InputError when it cannot write.
  template <ProtobufMessage Message>
  void Write(const FoxgloveTopic<Message>& topic, Time time, const Message& message) {
    Put(InfoOf(topic), time, ProtobufBytesOf(message));
  }

  // Writes the result of 'make', which is called only if somebody wants the message.
  template <ProtobufMessage Message, class Make>
  void Offer(const FoxgloveTopic<Message>& topic, Time time, const Make& make) {
    if (Wants(topic.name)) Write<Message>(topic, time, make());
  }

 private:
  virtual bool Wants(std::string_view) { return true; }
  virtual void Put(const FoxgloveTopicInfo& topic, Time time, std::string message) = 0;
};

}  // namespace kestrel
