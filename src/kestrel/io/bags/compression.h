// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "kestrel/io/bags/decompression.h"

namespace kestrel {

// Returns "none", "bz2", "lz4" or "zstd".
const char* ToString(Compression compression);

// Returns 'bytes' compressed; they must be less than 2 GiB.
std::string Compress(Compression compression, std::string_view bytes);

}  // namespace kestrel
