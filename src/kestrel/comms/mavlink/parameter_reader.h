// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// The text of a field of characters, up to its first zero.
std::string_view TextOf(std::span<const char> field);
// 'text' into a field of characters, cut where the field ends.
void SetText(std::string_view text, std::span<char> field);

// The value of a parameter as a number, and that number as the autopilot wants it: PX4 has the bits
// of integers in the float. 'type' is MAV_PARAM_TYPE.
double ParameterValue(AutopilotKind kind, const mavlink::ParamValue& message);
float ParameterOnWire(AutopilotKind kind, std::uint8_t type, double value);

// Reads single parameters of an autopilot by name, and asks for each until it answers: never for
// all of them, which would take the line for seconds. One that was renamed (parameter_names.h) is
// asked for by all its names, and told by the first of them and in that one's unit, whichever the
// autopilot knows.
class ParameterReader {
 public:
  // How an autopilot has a parameter.
  struct Entry {
    std::string name;       // the autopilot's own
    double scale = 1;       // value in the unit of the first name over the autopilot's
    std::uint8_t type = 0;  // MAV_PARAM_TYPE
  };

  // Asks for this parameter (up to 16 characters), again if it is known already.
  void Want(std::string_view name);

  // What it was when it was told last; nothing: not told (yet).
  std::optional<double> Find(std::string_view name) const;
  // It was asked for often enough: the autopilot does not have it.
  bool IsMissing(std::string_view name) const;
  // How the autopilot has it; nothing: not told (yet).
  std::optional<Entry> EntryOf(std::string_view name) const;
  // Nothing is being asked for.
  bool is_done() const;

  void Handle(AutopilotKind kind, const mavlink::ParamValue& message);
  // The autopilot started again: all is asked for again.
  void AskAgain();

  // Name of a parameter that is to be asked for at 'now'; empty: none. At most one per 50 ms.
  std::string_view Next(Time now);

 private:
  struct Parameter {
    std::string name;                // the first of its names
    std::vector<Entry> names;        // that it may have
    std::size_t asked = 0;           // the next of them to ask for
    std::optional<std::size_t> own;  // the autopilot's
    double value = 0;                // where that is known
    bool is_wanted = true;
    int requests = 0;
    Time due{};
  };
  const Parameter* Get(std::string_view name) const;
  static void Start(Parameter* parameter);

  std::vector<Parameter> parameters_;
  Time next_{};
};

}  // namespace kestrel
