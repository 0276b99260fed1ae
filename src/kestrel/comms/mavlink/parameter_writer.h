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
  kNone,        // was not asked for
  kWaiting,     // on its way
  kWritten,     // the autopilot told the value back
  kRefused,     // it told another value, however often it was asked
  kUnanswered,  // it told nothing, or does not have the parameter
};
const char* ToString(ParameterWriteState state);  // "written", "refused", ...

// Writes parameters of an autopilot, again and again until it tells them back.
class ParameterWriter {
 public:
  // 'name' and 'value' as the reader has them: the first name, in that one's unit. The reader has
  // to want it, or to know it: what type it is the autopilot has to tell first.
  void Set(std::string_view name, double value);

  ParameterWriteState StateOf(std::string_view name) const;
  // Nothing is on its way.
  bool is_done() const;

  void Handle(AutopilotKind kind, const mavlink::ParamValue& message,
              const ParameterReader& reader);

  // The message that is to be sent at 'now', without its target; nothing: none is. At most one per
  // 50 ms.
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
