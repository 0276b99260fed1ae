// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace kestrel {

// The folder that the files of a run go to. Nothing that is there is overwritten unless asked for.
class OutputFolder {
 public:
  // Makes the folder if it is not there. 'allowance': how the user has files replaced, for
  // messages. Throws InputError when it cannot be made.
  OutputFolder(std::filesystem::path folder, bool replace_files, std::string allowance = "--force");

  // Path of the new file 'name' (with its folders made); 'name' stays below the folder whatever it
  // is ("/a/../b.png" gives "a/b.png"). Throws InputError when there is such a file and
  // 'replace_files' is off, or its folder cannot be made.
  std::filesystem::path NewFile(const std::filesystem::path& name) const;

  // The same, opened. Throws InputError when it is not writable.
  std::ofstream OpenText(const std::filesystem::path& name) const;

 private:
  std::filesystem::path folder_;
  bool replace_files_;
  std::string allowance_;
};

// Writes and flushes 'text', for whoever reads along. Throws InputError, with the file's 'name',
// when it cannot be written.
void WriteAtOnce(const std::string& text, const char* name, std::ostream* file);

}  // namespace kestrel
