// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include "kestrel/io/bags/byte_source.h"

namespace kestrel {

// CRC-32 (that of zip and MCAP) of some bytes, or of those that have 'before' and these.
std::uint32_t Checksum(std::string_view bytes, std::uint32_t before = 0);

// That of the first 'size' bytes, read in pieces. Throws InputError as they do.
std::uint32_t ChecksumOf(ByteSource* bytes, std::uint64_t size);

}  // namespace kestrel
