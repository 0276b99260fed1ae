// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace kestrel {

enum class FileKind { kImage, kVideo, kOther };

// What a file is by the extension of its name, in whatever case. (By its content one could not:
// FFmpeg opens even a text as a video.)
FileKind FileKindOf(const std::filesystem::path& path);

}  // namespace kestrel
