// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/base/time.h"
#include "kestrel/link/autopilot_kind.h"
#include "kestrel/link/messages.h"

namespace kestrel {

// The text of a field of characters, up to its first zero.
std::string_view TextOf(std::span<const char> field);
// 'text' into a field of characters, cut where the field ends.
void SetText(std::string_view text, std::span<char> field);

// The value of a parameter as a number: PX4 has the bits of integers in the float.
double ParameterValue(AutopilotKind kind, const mavlink::ParamValue& message);

// Reads single parameters of an autopilot by name, and asks for each until it answers: never for
// all of them, which would take the line for seconds.
class ParameterReader {
 public:
  // Asks for this parameter (up to 16 characters), again if it is known already.
  void Want(std::string_view name);

  // What it was when it was told last; nothing: not told (yet).
  std::optional<double> Find(std::string_view name) const;
  // It was asked for often enough: the autopilot does not have it.
  bool IsMissing(std::string_view name) const;
  // Nothing is being asked for.
  bool is_done() const;

  void Handle(AutopilotKind kind, const mavlink::ParamValue& message);
  // The autopilot started again: all is asked for again.
  void AskAgain();

  // Name of a parameter that is to be asked for at 'now'; empty: none. At most one per 50 ms.
  std::string_view Next(Time now);

 private:
  struct Parameter {
    std::string name;
    std::optional<double> value;
    bool is_wanted = true;
    int requests = 0;
    Time due{};
  };
  const Parameter* Get(std::string_view name) const;

  std::vector<Parameter> parameters_;
  Time next_{};
};

}  // namespace kestrel
