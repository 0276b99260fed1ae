// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "kestrel/comms/mavlink/message_layout.h"

namespace kestrel::mavlink {

// Properties of a message.
struct MessageInfo {
  std::uint32_t id;
  std::string_view name;
  const MessageLayout* layout;
};

// All messages of messages.h, by id.
std::span<const MessageInfo> KnownMessages();

// Returns one of them; null for an unknown id.
const MessageInfo* FindMessage(std::uint32_t id);

}  // namespace kestrel::mavlink
