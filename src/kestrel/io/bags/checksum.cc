// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/checksum.h"

#include <algorithm>
#include <zlib.h>

namespace kestrel {

std::uint32_t Checksum(std::string_view bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::uint32_t ChecksumOf(ByteSource* bytes, std::uint64_t size) {
  constexpr std::uint64_t kPiece = 4
                                   << 20;  // a usual chunk at once, which is then read from memory
  std::uint32_t checksum = 0;
  for (std::uint64_t offset = 0; offset < size; offset += kPiece) {
    checksum = Checksum(bytes->View(offset, std::min(kPiece, size - offset)), checksum);
  }
  return checksum;
}

}  // namespace kestrel
