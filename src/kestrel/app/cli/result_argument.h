// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace kestrel {

// Removes the output of a command from the sources: a folder with a table of this name
// ("landing_detections.csv"), or a CSV file itself. Returns the path of the table; nothing when
// there is none. Throws InputError when there are several, or no other source.
std::optional<std::string> TakeResult(const std::string& table_name,
                                      std::vector<std::string>* sources);

}  // namespace kestrel
