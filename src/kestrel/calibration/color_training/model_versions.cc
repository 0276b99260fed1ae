// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/model_versions.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/write_file.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxVersion = 9999;

std::vector<std::string> Lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Length of the longest common subsequence of two texts' tails, from line i of the one and line j
// of the other.
class CommonTails {
 public:
  CommonTails(const std::vector<std::string>& a, const std::vector<std::string>& b)
      : columns_(b.size() + 1), counts_((a.size() + 1) * columns_) {
    for (std::size_t i = a.size(); i-- > 0;) {
      for (std::size_t j = b.size(); j-- > 0;) {
        counts_[i * columns_ + j] =
            a[i] == b[j] ? At(i + 1, j + 1) + 1 : std::max(At(i + 1, j), At(i, j + 1));
      }
    }
  }
  int At(std::size_t i, std::size_t j) const { return counts_[i * columns_ + j]; }

 private:
  std::size_t columns_;
  std::vector<int> counts_;
};

// The next number after the highest one: the number of a version that was removed is not used
// again.
std::string NextVersion(const std::string& path) {
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
  ParseObjectModel(text, path);  // a model that cannot be read is not written
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

std::vector<std::string> ModelVersions(const std::string& path) {
  std::vector<std::string> versions;
  for (int version = 1; version <= kMaxVersion; ++version) {
    const std::string name = fmt::format("{}.{}", path, version);
    if (fs::exists(name)) versions.push_back(name);
  }
  return versions;
}

std::vector<std::string> LineDifference(const std::string& before, const std::string& after) {
  const std::vector<std::string> a = Lines(before);
  const std::vector<std::string> b = Lines(after);
  const CommonTails tails(a, b);
  std::vector<std::string> difference;
  std::string heading;
  const auto add = [&](const char* sign, const std::string& line) {
    if (!heading.empty()) difference.push_back("  " + heading);
    heading.clear();
    difference.push_back(sign + line);
  };
  for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
    if (i < a.size() && j < b.size() && a[i] == b[j]) {
      if (a[i].find("name:") != std::string::npos) heading = a[i];
      ++i, ++j;
    } else if (j == b.size() || (i < a.size() && tails.At(i + 1, j) >= tails.At(i, j + 1))) {
      add("- ", a[i++]);
    } else {
      add("+ ", b[j++]);
    }
  }
  return difference;
}

}  // namespace kestrel
