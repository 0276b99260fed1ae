// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kestrel {

enum class AutopilotFirmware { kArduPilot, kPx4 };

// One parameter with its real value: integers are whole numbers here, however MAVLink carries them.
struct AutopilotParameter {
  std::string name;
  double value = 0;
  bool is_integer = false;
};

// The parameters of a firmware that affect landing, with their defaults.
class AutopilotParameters {
 public:
  explicit AutopilotParameters(AutopilotFirmware firmware);

  // Value of a parameter that exists; the rules know the names.
  double operator[](std::string_view name) const;

  std::optional<std::size_t> Find(std::string_view name) const;
  const AutopilotParameter& at(std::size_t index) const { return parameters_[index]; }
  void Set(std::size_t index, double value);
  std::size_t size() const { return parameters_.size(); }

 private:
  std::vector<AutopilotParameter> parameters_;
};

}  // namespace kestrel
