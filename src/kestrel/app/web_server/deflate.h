// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace kestrel {

// Compresses the bytes for HTTP's content coding "deflate" (RFC 9110, 8.4.1.2), for speed rather
// than size. Throws std::bad_alloc when there is no memory.
std::string Deflate(std::string_view bytes);

// Decompresses the bytes of a gzip file that the build made. Throws std::bad_alloc when there is no
// memory.
std::string Gunzip(std::string_view bytes);

}  // namespace kestrel
