// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace kestrel {

enum class FileKind { kImage, kVideo, kOther };

// Returns the kind of a file by the extension of its name, in upper or lower case. Containers of
// videos have no common mark in their content.
FileKind FileKindOf(const std::filesystem::path& path);

}  // namespace kestrel
