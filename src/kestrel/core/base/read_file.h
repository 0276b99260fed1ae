// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// Returns all bytes of a file. Throws InputError when the file does not exist, is a folder, or
// cannot be read.
std::string ReadFile(const std::string& path);

}  // namespace kestrel
