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

// Returns the text of a character field, up to its first zero.
std::string_view TextOf(std::span<const char> field);
// Writes 'text' to a character field, truncated at its end.
void SetText(std::string_view text, std::span<char> field);

// Convert a parameter's value from and to the wire: PX4 puts the bits of integers into the float.
// 'type' is MAV_PARAM_TYPE. The value of a float is the shortest decimal number for it, as a user
// typed it.
double ParameterValue(AutopilotKind kind, const mavlink::ParamValue& message);
float ParameterOnWire(AutopilotKind kind, std::uint8_t type, double value);

// Reads single parameters of an autopilot by name, and requests each until it answers. It never
// requests all of them, which would occupy the line for seconds. A renamed parameter
// (parameter_names.h) is requested by all its names; its value is given by the first name and in
// that name's unit, whichever the autopilot knows.
class ParameterReader {
 public:
  // A parameter as the autopilot has it.
  struct Entry {
    std::string name;       // the autopilot's own
    double scale = 1;       // value in the first name's unit divided by the autopilot's value
    std::uint8_t type = 0;  // MAV_PARAM_TYPE
  };

  // Requests this parameter (up to 16 characters), again if it is already known.
  void Want(std::string_view name);

  // Returns the newest reported value; nothing while there is none.
  std::optional<double> Find(std::string_view name) const;
  // True when it was requested often enough: the autopilot does not have it.
  bool IsMissing(std::string_view name) const;
  // Returns the autopilot's own entry; nothing while none was reported.
  std::optional<Entry> EntryOf(std::string_view name) const;
  // True when no request is open.
  bool is_done() const;

  void Handle(AutopilotKind kind, const mavlink::ParamValue& message);
  // The autopilot has restarted: all parameters are requested again.
  void RequestAgain();

  // Returns the name of a parameter to request at 'now'; empty: none. At most one per 50 ms.
  std::string_view Next(Time now);

 private:
  struct Parameter {
    std::string name;                // first of its names
    std::vector<Entry> names;        // all possible names
    std::size_t requested = 0;       // index of the next name to request
    std::optional<std::size_t> own;  // index of the autopilot's name
    double value = 0;                // value, once that is known
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
