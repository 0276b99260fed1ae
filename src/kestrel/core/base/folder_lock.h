// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// Keeps other programs that ask for it from writing into a folder, as long as this lives and the
// program does: what is killed leaves no lock behind.
class FolderLock {
 public:
  // Throws InputError when another holds the lock, or the folder cannot be opened.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace kestrel
