// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/bag_folder.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/load_yaml.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/shown.h"
#include "kestrel/io/recording/media/file_kind.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";
constexpr const char* kRoot = "rosbag2_bagfile_information";

bool IsStorageFile(const fs::path& path) {
  return path.extension() == ".db3" || path.extension() == ".mcap" || IsCompressedBagFile(path);
}

// Returns the number of a part of a bag, before the extension ("flight_12.mcap"); 0 without one.
unsigned long PartOf(const fs::path& path) {
  const std::string stem = path.stem().string();
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  constexpr std::size_t kMaxDigits = 9;
  const std::string number = stem.substr(digits, kMaxDigits);
  return number.empty() ? 0 : std::stoul(number);
}

std::vector<std::string> StorageFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (IsStorageFile(entry.path()) && !IsHidden(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(PartOf(a), a) < std::pair(PartOf(b), b);
  });
  return {files.begin(), files.end()};
}

std::string Scalar(const YAML::Node& node, const char* key) {
  const YAML::Node value = node[key];
  return value && value.IsScalar() ? value.Scalar() : "";
}

BagFolder ParseMetadata(const std::string& text, const fs::path& folder) {
  const std::string file = (folder / kMetadata).string();
  const YAML::Node root = LoadYaml(text, file);
  const YAML::Node bag = root.IsMap() ? root[kRoot] : YAML::Node();
  if (!bag || !bag.IsMap()) {
    throw InputError(fmt::format("{}: has no key '{}', expected it", file, kRoot));
  }
  const std::string mode = Scalar(bag, "compression_mode");
  const std::string format = Scalar(bag, "compression_format");
  BagFolder result;
  if (mode == "MESSAGE" || mode == "message") {
    if (format != "zstd") {
      throw InputError(
          fmt::format("{}: 'compression_format' is '{}', expected zstd", file, Shown(format)));
    }
    result.has_compressed_messages = true;
  } else if (mode == "FILE" || mode == "file") {
    throw InputError(
        fmt::format("{}: the bag's files are compressed as a whole, expected them decompressed "
                    "(zstd -d -o NAME.mcap NAME.mcap.zstd) and given one by one",
                    file));
  }
  const YAML::Node paths = bag["relative_file_paths"];
  if (!paths || !paths.IsSequence() || paths.size() == 0) {
    throw InputError(fmt::format("{}: has no list 'relative_file_paths', expected it", file));
  }
  for (const YAML::Node& node : paths) {
    const fs::path path = folder / (node.IsScalar() ? node.Scalar() : "");
    // Early bags contain the paths at the time of recording.
    const fs::path beside = folder / path.filename();
    std::error_code ignored;  // a name may be too long for any file
    const fs::path& found = fs::exists(path, ignored) ? path : beside;
    if (!fs::is_regular_file(found, ignored)) {
      throw InputError(fmt::format("{}: the file {} is not there, expected it", file,
                                   Shown(path.string(), /*max_length=*/1000)));
    }
    result.files.push_back(found.string());
  }
  return result;
}

}  // namespace

bool IsCompressedBagFile(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.ends_with(".db3.zstd") || name.ends_with(".mcap.zstd");
}

bool IsBagFolder(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return false;
  if (!StorageFilesIn(folder).empty()) return true;
  const fs::path metadata = folder / kMetadata;
  return fs::is_regular_file(metadata, ignored) &&
         ReadFile(metadata.string()).find(kRoot) != std::string::npos;
}

BagFolder ReadBagFolder(const fs::path& folder) {
  const fs::path metadata = folder / kMetadata;
  std::error_code ignored;
  if (!fs::exists(metadata, ignored)) return {StorageFilesIn(folder), false};
  return ParseMetadata(ReadFile(metadata.string()), folder);
}

}  // namespace kestrel
