// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/write_file.h"

#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// Waits until the file's bytes are on the disk: a rename that comes first would, after a power
// loss, leave an empty file in the place of the old one.
void Sync(const std::string& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

void Replace(const std::string& path, std::string_view bytes, bool syncs) {
  // In the same folder, because rename is atomic only within one file system.
  const std::string draft = path + ".part";
  std::ofstream file(draft, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file && syncs) Sync(draft);
  std::error_code error;
  if (file) std::filesystem::rename(draft, path, error);
  if (file && !error) return;
  std::error_code ignored;
  std::filesystem::remove(draft, ignored);
  throw InputError(path + ": cannot be written");
}

}  // namespace

void WriteFile(const std::string& path, std::string_view bytes) {
  Replace(path, bytes, /*syncs=*/true);
}

void ReplaceFile(const std::string& path, std::string_view bytes) {
  Replace(path, bytes, /*syncs=*/false);
}

}  // namespace kestrel
