// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace kestrel {

// Replaces the file at 'path' by one with these bytes, atomically: whoever reads it, and whatever
// happens meanwhile, finds the old file or the new one as a whole. Throws InputError when it cannot
// be written; the old file is then as it was.
void WriteFile(const std::string& path, std::string_view bytes);

}  // namespace kestrel
