// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace kestrel {

// Atomically replaces the file at 'path' by one with these bytes: at any time, and after a power
// loss, readers find either the complete old file or the complete new one. Waits for the disk.
// Throws InputError when it cannot be written; the old file then stays unchanged.
void WriteFile(const std::string& path, std::string_view bytes);

// The same without waiting for the disk: what a power loss leaves is the file system's choice until
// it is synced.
void ReplaceFile(const std::string& path, std::string_view bytes);

}  // namespace kestrel
