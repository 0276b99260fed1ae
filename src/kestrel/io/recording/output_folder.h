// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace kestrel {

// The folder for the files of a run. Existing files are not overwritten unless requested.
class OutputFolder {
 public:
  // Creates the folder if it does not exist. 'allowance': the option with which the user has files
  // replaced, for messages. Throws InputError when the folder cannot be created.
  OutputFolder(std::filesystem::path folder, bool replace_files, std::string allowance = "--force");

  // Returns the path of the new file 'name' and creates its folders. The file stays below the
  // folder whatever 'name' is ("/a/../b.png" gives "a/b.png"). Throws InputError when the file
  // exists and 'replace_files' is false, or when its folder cannot be created.
  std::filesystem::path NewFile(const std::filesystem::path& name) const;

  // Opens such a file. Throws InputError when it cannot be written.
  std::ofstream OpenText(const std::filesystem::path& name) const;

 private:
  std::filesystem::path folder_;
  bool replace_files_;
  std::string allowance_;
};

// Writes and flushes 'text', for readers that follow the file. Throws InputError with the file's
// 'name' when it cannot be written.
void WriteAtOnce(const std::string& text, const char* name, std::ostream* file);

}  // namespace kestrel
