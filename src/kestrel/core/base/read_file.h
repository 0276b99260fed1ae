// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// All bytes of a file. Throws InputError when there is no such file, when it is a folder, or when
// it cannot be read.
std::string ReadFile(const std::string& path);

}  // namespace kestrel
