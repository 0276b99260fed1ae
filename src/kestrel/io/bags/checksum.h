// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include "kestrel/io/bags/byte_source.h"

namespace kestrel {

// Returns the CRC-32 (as in zip and MCAP) of some bytes; 'before': CRC-32 of the bytes before them.
std::uint32_t Checksum(std::string_view bytes, std::uint32_t before = 0);

// Returns the CRC-32 of the first 'size' bytes, read in pieces. Throws InputError as the source
// does.
std::uint32_t ChecksumOf(ByteSource* bytes, std::uint64_t size);

}  // namespace kestrel
