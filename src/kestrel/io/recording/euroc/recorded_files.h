// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace kestrel {

// Files of a recording that grow row by row. Every row on the disk is complete, and the data that
// it refers to are on the disk: rows are kept in memory until Commit, which first syncs all other
// data to the disk. While the disk is full they stay in memory.
class RecordedFiles {
 public:
  struct File {
    std::filesystem::path path;
    std::string header;  // first row of the file
  };

  // A file is made when its first row is committed. 'folder': everything that the rows refer to is
  // on its file system. Throws InputError when it cannot be opened.
  RecordedFiles(const std::filesystem::path& folder, std::vector<File> files);
  ~RecordedFiles();
  RecordedFiles(const RecordedFiles&) = delete;
  RecordedFiles& operator=(const RecordedFiles&) = delete;

  // Adds complete rows for the file 'index'. When more than 4 MB wait, further rows are dropped.
  // Called by any thread.
  void Add(std::size_t index, std::string_view rows);

  // Returns the number of bytes that wait for Commit. Called by any thread.
  std::size_t waiting_bytes() const;

  // Writes all added rows and waits for the disk, if there are any. Returns an empty text or the
  // reason why some rows could not be written; these are tried again. One thread at a time.
  std::string Commit();

 private:
  struct Growing {
    File file;
    std::string added;      // guarded by the lock
    std::string committed;  // rows that Commit is writing, or failed to write
    int descriptor = -1;
    std::int64_t size = 0;
  };
  // Return the error: as text, or as 0 or the system's error number.
  std::string Write(Growing* file);
  static int Begin(Growing* file);
  static int Append(const std::string& text, Growing* file);

  int folder_descriptor_;
  mutable std::mutex mutex_;
  std::vector<Growing> files_;
};

}  // namespace kestrel
