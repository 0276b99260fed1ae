// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace kestrel {

enum class FileKind { kImage, kVideo, kOther };

// Returns the kind of a file by the extension of its name, in upper or lower case. Containers of
// videos have no common mark in their content.
FileKind FileKindOf(const std::filesystem::path& path);

// True when the file's name is that of a TIFF, which alone may hold several images.
bool MayHavePages(const std::filesystem::path& path);

// True for files and folders that a system and not a person has put into a folder: whose name
// begins with a dot (macOS's ._NAME, .thumbnails), and those of archives, Windows and network
// disks.
bool IsHidden(const std::filesystem::path& path);

}  // namespace kestrel
