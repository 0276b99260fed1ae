// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace kestrel {

// Throws InputError when a recording must not replace what is at 'output': a file, a folder with
// other content, or a recording unless 'replace'.
void RequireFreeForRecording(const std::filesystem::path& output, bool replace);

// The place of a recording: absolute, and without a slash at its end.
std::filesystem::path PlaceOfRecording(const std::filesystem::path& output);
// The folder of its files until it is complete: "<output>.part".
std::filesystem::path PartOfRecording(const std::filesystem::path& output);
// Gives a complete recording its place, which loses what it had. Throws InputError when that cannot
// be.
void PublishRecording(const std::filesystem::path& part, const std::filesystem::path& output);

}  // namespace kestrel
