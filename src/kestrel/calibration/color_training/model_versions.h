// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// Writes the model as YAML for `--model` and reads it back. What the file held before, where that
// was anything else, is kept beside it as 'path'.1, .2 and so on, the highest the newest; returns
// that name, or nothing. Throws InputError when it cannot be written, or when there are 9999
// versions; the file is then as it was.
std::string SaveModelVersion(const std::string& path, const ObjectModel& model);

// File names of the versions of 'path' that are kept beside it, the newest last.
std::vector<std::string> ModelVersions(const std::string& path);

// The lines that two texts differ in, as diff has them: "- " before one that only 'before' has, "+
// " before one of 'after'; ahead of them, with two spaces, the last line above that names a colour.
std::vector<std::string> LineDifference(const std::string& before, const std::string& after);

}  // namespace kestrel
