// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "kestrel/comms/mavlink/message_layout.h"

namespace kestrel::mavlink {

// What is known of a message by its id.
struct MessageInfo {
  std::uint32_t id;
  std::string_view name;
  const MessageLayout* layout;
};

// All messages of messages.h, by id.
std::span<const MessageInfo> KnownMessages();

// One of them; null when the id is not among them.
const MessageInfo* FindMessage(std::uint32_t id);

}  // namespace kestrel::mavlink
