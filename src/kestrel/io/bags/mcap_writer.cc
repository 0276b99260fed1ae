// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/mcap_writer.h"

#include "kestrel/io/bags/qos_text.h"
#include "kestrel/io/ros_messages/message_definitions.h"

namespace kestrel {

std::size_t McapWriter::AddTopic(const std::string& name, std::string_view type, bool is_latched) {
  return file_.AddChannel({.topic = name,
                           .message_encoding = "cdr",
                           .schema_name = Ros2TypeName(type),
                           .schema_encoding = "ros2msg",
                           .schema = MessageDefinition(type, WireFormat::kCdr),
                           .metadata = {{"offered_qos_profiles", QosText(is_latched)}}});
}

}  // namespace kestrel
