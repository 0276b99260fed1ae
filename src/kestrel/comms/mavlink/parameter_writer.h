// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/parameter_reader.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

enum class ParameterWriteState {
  kNone,        // no write was requested
  kWaiting,     // no confirmation yet
  kWritten,     // the autopilot reported the value back
  kRefused,     // it reported another value after every request
  kUnanswered,  // it reported nothing, or does not have the parameter
};
const char* ToString(ParameterWriteState state);  // "written", "refused", ...

// Writes parameters of an autopilot, and repeats each until the autopilot reports it back.
class ParameterWriter {
 public:
  // 'name' and 'value' as in the reader: the first name, in that name's unit. The reader must have
  // requested the parameter or know it: the autopilot has to report its type first.
  void Set(std::string_view name, double value);

  ParameterWriteState StateOf(std::string_view name) const;
  // True when no write is open.
  bool is_done() const;

  void Handle(AutopilotKind kind, const mavlink::ParamValue& message,
              const ParameterReader& reader);

  // Returns the message to send at 'now', without its target; nothing: none. At most one per 50 ms.
  std::optional<mavlink::ParamSet> Next(AutopilotKind kind, const ParameterReader& reader,
                                        Time now);

 private:
  struct Write {
    std::string name;
    double value = 0;
    ParameterWriteState state = ParameterWriteState::kWaiting;
    bool was_answered = false;
    int requests = 0;
    Time due{};
  };

  std::vector<Write> writes_;
  Time next_{};
};

}  // namespace kestrel
