// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace YAML {
class Node;
}

namespace kestrel {

// Returns the root of a YAML (or JSON) text. A byte order mark is skipped, and so is the
// "%YAML:1.0" that OpenCV starts its files with, which is not the directive that YAML defines; line
// numbers stay right. Throws InputError with 'file' and line for anything else: binary data, a tab
// in the indentation, a text that ends too early.
YAML::Node LoadYaml(std::string_view text, const std::string& file);

}  // namespace kestrel
