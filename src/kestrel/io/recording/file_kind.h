// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace kestrel {

enum class FileKind { kImage, kVideo, kOther };

// Returns the kind of a file by the extension of its name, in upper or lower case. The content does
// not tell it: FFmpeg opens even a text as a video.
FileKind FileKindOf(const std::filesystem::path& path);

}  // namespace kestrel
