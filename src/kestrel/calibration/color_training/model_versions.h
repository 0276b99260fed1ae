// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// Writes the model as YAML for `--model` and reads it back. If the file had another content before,
// that is kept beside it as 'path'.1, .2 and so on, the highest number being the newest; returns
// that name, or nothing. Throws InputError when it cannot be written or there are 9999 versions;
// the file is then unchanged.
std::string SaveModelVersion(const std::string& path, const ObjectModel& model);

// Returns the file names of the versions beside 'path', the newest last.
std::vector<std::string> ModelVersions(const std::string& path);

// Returns the lines that differ, as diff does: "- " before a line that only 'before' has, "+ "
// before one of 'after'. Before them, with two spaces, comes the last line above that names a
// colour.
std::vector<std::string> LineDifference(const std::string& before, const std::string& after);

}  // namespace kestrel
