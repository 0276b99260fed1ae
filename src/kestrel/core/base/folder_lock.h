// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

// Keeps other programs that use FolderLock from writing into a folder, for the lifetime of this
// object and of the program. A killed program leaves no lock behind.
class FolderLock {
 public:
  // Throws InputError when another program holds the lock or the folder cannot be opened.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace kestrel
