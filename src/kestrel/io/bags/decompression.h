// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kestrel {

enum class Compression { kNone, kBz2, kLz4, kZstd };

// Returns the compression with this name in a bag: "", "none", "bz2", "lz4", "zstd". Throws
// InputError with 'name', the name of the compressed part, for any other.
Compression CompressionOf(std::string_view word, const std::string& name);

// Decompresses 'bytes' into 'output': 'size' bytes, if that is known, or the available part of
// bytes that were cut off. Throws InputError with 'name' when they are broken, have another size,
// or need more than 1 GiB.
void Decompress(Compression compression, std::string_view bytes, std::optional<std::uint64_t> size,
                const std::string& name, std::string* output);

}  // namespace kestrel
