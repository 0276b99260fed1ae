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

// Files of a recording that grow row by row, and of which every row that is on the disk is whole,
// and is about things that are there: rows are kept in memory until Commit, which first has the
// system write all else to the disk. A full disk keeps them there until there is room again.
class RecordedFiles {
 public:
  struct File {
    std::filesystem::path path;
    std::string header;  // its first row
  };

  // A file is made when its first row is committed. 'folder': all that the rows are about is on its
  // file system. Throws InputError when it cannot be opened.
  RecordedFiles(const std::filesystem::path& folder, std::vector<File> files);
  ~RecordedFiles();
  RecordedFiles(const RecordedFiles&) = delete;
  RecordedFiles& operator=(const RecordedFiles&) = delete;

  // Whole rows for the file 'index'; more than 4 MB that wait are dropped. By any thread.
  void Add(std::size_t index, std::string_view rows);

  // Writes all rows that were added, and waits for the disk. Returns an empty text or, in words,
  // why some rows could not be written; these are tried again. One thread at a time.
  std::string Commit();

 private:
  struct Growing {
    File file;
    std::string added;      // under the lock
    std::string committed;  // what Commit is at, or failed to write
    int descriptor = -1;
    std::int64_t size = 0;
  };
  // What went wrong: in words, or 0 or the system's number.
  std::string Write(Growing* file);
  static int Begin(Growing* file);
  static int Append(const std::string& text, Growing* file);

  int folder_descriptor_;
  std::mutex mutex_;
  std::vector<Growing> files_;
};

}  // namespace kestrel
