// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/device_fault.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <grp.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace kestrel {
namespace {

namespace fs = std::filesystem;

bool IsVideo(const std::string& path) {
  return fs::path(path).filename().string().starts_with("video");
}

// Returns the devices of the same kind that there are.
std::vector<std::string> Others(const std::string& path) {
  const auto is_kin = [&](const std::string& name) {
    if (IsVideo(path)) return name.starts_with("video");
    return name.starts_with("serial") ||
           (name.starts_with("tty") && name.size() > 4 && name[3] >= 'A' && name[3] <= 'Z');
  };
  std::vector<std::string> others;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path(), ignored)) {
    if (is_kin(entry.path().filename().string()) && entry.is_character_file(ignored)) {
      others.push_back(entry.path().string());
    }
  }
  std::sort(others.begin(), others.end());
  return others;
}

// The group that may use the device; if the system has no information, the one that Debian gives
// it.
std::string GroupOf(const std::string& path) {
  struct stat status {};
  const bool is_groups =
      stat(path.c_str(), &status) == 0 && status.st_gid != 0 && (status.st_mode & S_IWGRP) != 0;
  const group* const found = is_groups ? getgrgid(status.st_gid) : nullptr;
  if (found != nullptr) return found->gr_name;
  return IsVideo(path) ? "video" : "dialout";
}

std::string Missing(const std::string& path) {
  const std::vector<std::string> others = Others(path);
  return fmt::format("there is no {}, {}; is it plugged in?", path,
                     others.empty() ? "nor another device of its kind"
                                    : fmt::format("but {}", fmt::join(others, ", ")));
}

}  // namespace

std::string UsersOf(const std::string& path) {
  std::error_code error;
  const fs::path device = fs::canonical(path, error);
  if (error) return "";
  std::vector<std::string> users;
  for (const auto& process : fs::directory_iterator("/proc", error)) {
    const std::string id = process.path().filename().string();
    if (id.find_first_not_of("0123456789") != std::string::npos || id == std::to_string(getpid())) {
      continue;
    }
    std::error_code denied;
    for (const auto& file : fs::directory_iterator(process.path() / "fd", denied)) {
      if (fs::read_symlink(file.path(), denied) != device) continue;
      std::string name;
      std::getline(std::ifstream(process.path() / "comm"), name);
      users.push_back(fmt::format("{} (process {})", name, id));
      break;
    }
  }
  return fmt::format("{}", fmt::join(users, ", "));
}

std::string DeviceFault(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
      return Missing(path);
    case EACCES:
    case EPERM:
      return fmt::format("{}: no permission: sudo usermod -aG {} $USER, then log out and in again",
                         path, GroupOf(path));
    case EBUSY:
    case EWOULDBLOCK: {
      const std::string users = UsersOf(path);
      return fmt::format("{}: in use by {}", path, users.empty() ? "another program" : users);
    }
    case ENODEV:
    case ENXIO:
    case EIO:
      return path + ": the device does not answer: unplug it and plug it in again, see dmesg";
    default:
      return fmt::format("{}: cannot be opened: {}", path, std::generic_category().message(error));
  }
}

}  // namespace kestrel
