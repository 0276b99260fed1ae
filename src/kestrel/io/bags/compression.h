// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "kestrel/io/bags/decompression.h"

namespace kestrel {

// "none", "bz2", "lz4", "zstd"
const char* ToString(Compression compression);

// 'bytes' compressed; below 2 GiB of them.
std::string Compress(Compression compression, std::string_view bytes);

}  // namespace kestrel
