// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace kestrel {

// Takes what a command wrote, a folder with the table of this name ("landing_detections.csv") or
// such a file itself, out of the sources. Returns the path of the table; nothing when there is
// none. Throws InputError when there are several, or nothing else.
std::optional<std::string> TakeResult(const std::string& table_name,
                                      std::vector<std::string>* sources);

}  // namespace kestrel
