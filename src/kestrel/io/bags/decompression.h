// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kestrel {

enum class Compression { kNone, kBz2, kLz4, kZstd };

// The compression that a bag calls so: "", "none", "bz2", "lz4", "zstd". Throws InputError, with
// the 'name' of what is compressed, for another.
Compression CompressionOf(std::string_view word, const std::string& name);

// Fills 'output' with what 'bytes' are compressed from: 'size' bytes, where that is known, or the
// part that could be had of bytes that were cut off. Throws InputError, with 'name', when they are
// broken, of another size, or would need more than 1 GiB.
void Decompress(Compression compression, std::string_view bytes, std::optional<std::uint64_t> size,
                const std::string& name, std::string* output);

}  // namespace kestrel
