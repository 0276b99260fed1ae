// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/bag_writer.h"

#include <filesystem>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/compression.h"
#include "kestrel/io/bags/mcap_writer.h"
#include "kestrel/io/bags/ros1_bag_writer.h"
#include "kestrel/io/bags/sqlite_writer.h"

namespace kestrel {
namespace {

std::string ExtensionOf(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

}  // namespace

bool IsBagName(const std::string& path) {
  const std::string extension = ExtensionOf(path);
  return extension == ".bag" || extension == ".mcap" || extension == ".db3";
}

std::unique_ptr<BagWriter> NewBag(const std::string& path, Compression compression, bool replace) {
  const std::string extension = ExtensionOf(path);
  const bool is_none = compression == Compression::kNone;
  const bool is_lz4 = compression == Compression::kLz4;
  if (extension == ".bag" && (is_none || is_lz4 || compression == Compression::kBz2)) {
    return std::make_unique<Ros1BagWriter>(path, compression, replace);
  }
  if (extension == ".mcap" && (is_none || is_lz4 || compression == Compression::kZstd)) {
    return std::make_unique<McapWriter>(path, compression, replace);
  }
  if (extension == ".db3" && is_none) return std::make_unique<SqliteWriter>(path, replace);
  throw InputError(fmt::format(
      "{}: cannot be written with compression {}, expected none, bz2 or lz4 for .bag, none, lz4 or "
      "zstd for .mcap, none for .db3",
      path, ToString(compression)));
}

}  // namespace kestrel
