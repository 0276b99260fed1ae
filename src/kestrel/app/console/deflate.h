// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace kestrel {

// The bytes as HTTP's content coding "deflate" has them (RFC 9110, 8.4.1.2), quickly rather than
// small. Throws std::bad_alloc when there is no memory.
std::string Deflate(std::string_view bytes);

}  // namespace kestrel
