// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/read_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include "kestrel/core/base/error.h"

namespace kestrel {

std::string ReadFile(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw InputError(path + ": no such file");
  // On Linux, opening a folder succeeds.
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(path + ": is a folder, expected a file");
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  if (!file) throw InputError(path + ": cannot be read");
  return bytes;
}

}  // namespace kestrel
