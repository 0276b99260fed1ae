// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace kestrel {

// An error in the user's input: a file, a key, a row, an option. The message is one line that names
// it and what was expected. Thrown only at construction, configuration and I/O.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace kestrel
