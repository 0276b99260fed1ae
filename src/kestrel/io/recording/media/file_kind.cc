// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/media/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

namespace kestrel {
namespace {

constexpr std::array<std::string_view, 9> kImages = {".png", ".jpg", ".jpeg", ".bmp", ".pgm",
                                                     ".ppm", ".tif", ".tiff", ".webp"};
constexpr std::array<std::string_view, 13> kVideos = {".mp4",   ".avi",  ".mkv",  ".mov", ".m4v",
                                                      ".webm",  ".mpg",  ".mpeg", ".ts",  ".wmv",
                                                      ".mjpeg", ".h264", ".h265"};

std::string ExtensionOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

}  // namespace

FileKind FileKindOf(const std::filesystem::path& path) {
  const std::string extension = ExtensionOf(path);
  const auto is_in = [&](const auto& extensions) {
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
  };
  if (is_in(kImages)) return FileKind::kImage;
  return is_in(kVideos) ? FileKind::kVideo : FileKind::kOther;
}

bool MayHavePages(const std::filesystem::path& path) {
  const std::string extension = ExtensionOf(path);
  return extension == ".tif" || extension == ".tiff";
}

bool IsHidden(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with('.') || name == "__MACOSX" || name == "@eaDir" || name == "$RECYCLE.BIN";
}

}  // namespace kestrel
