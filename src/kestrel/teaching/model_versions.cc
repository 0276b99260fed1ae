// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/teaching/model_versions.h"

#include <filesystem>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/read_file.h"
#include "kestrel/base/write_file.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// After the highest that is there: a version that was removed is not taken again.
std::string NextVersion(const std::string& path) {
  constexpr int kMaxVersion = 9999;
  for (int version = kMaxVersion; version > 0; --version) {
    if (!fs::exists(fmt::format("{}.{}", path, version))) continue;
    if (version == kMaxVersion) {
      throw InputError(fmt::format("{}: has {} versions, move some away", path, kMaxVersion));
    }
    return fmt::format("{}.{}", path, version + 1);
  }
  return path + ".1";
}

}  // namespace

std::string SaveModelVersion(const std::string& path, const ObjectModel& model) {
  const std::string text = PrintObjectModel(model);
  ParseObjectModel(text, path);  // what could not be read is not written
  std::string version;
  if (fs::exists(path)) {
    const std::string before = ReadFile(path);
    if (before == text) return "";
    version = NextVersion(path);
    WriteFile(version, before);
  }
  WriteFile(path, text);
  if (ReadFile(path) != text) throw InputError(path + ": does not hold what was written to it");
  return version;
}

}  // namespace kestrel
