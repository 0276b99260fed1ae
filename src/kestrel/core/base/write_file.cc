// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/write_file.h"

#include <filesystem>
#include <fstream>

#include "kestrel/core/base/error.h"

namespace kestrel {

void WriteFile(const std::string& path, std::string_view bytes) {
  // In the same folder, because rename is atomic only within one file system.
  const std::string draft = path + ".part";
  std::ofstream file(draft, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(draft, path, error);
  if (file && !error) return;
  std::error_code ignored;
  std::filesystem::remove(draft, ignored);
  throw InputError(path + ": cannot be written");
}

}  // namespace kestrel
