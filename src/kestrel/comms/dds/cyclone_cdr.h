// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <dds/dds.h>
#include <functional>
#include <string_view>

namespace kestrel {

// Messages as bytes of plain CDR, with the four bytes of their encapsulation. Cyclone DDS has no
// stable interface for that: cyclone_cdr.cc alone includes more of it than dds/dds.h, and CMake
// compiles it for a test before it builds with the Cyclone that it finds.

// Writes a message of the writer's type. False when the bytes are not of the type, or DDS does not
// accept them.
bool WriteCdr(dds_entity_t writer, const dds_topic_descriptor_t& type, std::string_view bytes);

// Passes all messages that wait to 'take'. 'bytes' last as long as the call.
void TakeCdr(dds_entity_t reader, const std::function<void(std::string_view bytes)>& take);

}  // namespace kestrel
