// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/parameter_writer.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

constexpr int kMaxWriteRequests = 5;

// True when the values are equal within the precision of the wire's float.
bool IsSameOnWire(double a, double b) {
  constexpr double kPrecision = 1e-6;
  return std::abs(a - b) <= kPrecision * std::max(1.0, std::abs(b));
}

}  // namespace

const char* ToString(ParameterWriteState state) {
  switch (state) {
    case ParameterWriteState::kNone:
      return "not written";
    case ParameterWriteState::kWaiting:
      return "waiting";
    case ParameterWriteState::kWritten:
      return "written";
    case ParameterWriteState::kRefused:
      return "refused";
    case ParameterWriteState::kUnanswered:
      return "unanswered";
  }
  return "";
}

void ParameterWriter::Set(std::string_view name, double value) {
  std::erase_if(writes_, [&](const Write& write) { return write.name == name; });
  Write write;
  write.name = name;
  write.value = value;
  writes_.push_back(write);
}

ParameterWriteState ParameterWriter::StateOf(std::string_view name) const {
  const auto found = std::find_if(writes_.begin(), writes_.end(),
                                  [&](const Write& write) { return write.name == name; });
  return found == writes_.end() ? ParameterWriteState::kNone : found->state;
}

bool ParameterWriter::is_done() const {
  return std::none_of(writes_.begin(), writes_.end(), [](const Write& write) {
    return write.state == ParameterWriteState::kWaiting;
  });
}

void ParameterWriter::Handle(AutopilotKind kind, const mavlink::ParamValue& message,
                             const ParameterReader& reader) {
  const std::string_view reported = TextOf(message.param_id);
  for (Write& write : writes_) {
    const auto entry = reader.EntryOf(write.name);
    // A value that comes before the first request is no answer.
    if (!entry || entry->name != reported || write.requests == 0) continue;
    write.was_answered = true;
    if (IsSameOnWire(entry->scale * ParameterValue(kind, message), write.value)) {
      write.state = ParameterWriteState::kWritten;
    }
  }
}

std::optional<mavlink::ParamSet> ParameterWriter::Next(AutopilotKind kind,
                                                       const ParameterReader& reader, Time now) {
  constexpr Duration kBetween = std::chrono::milliseconds(50);
  constexpr Duration kPatience = std::chrono::milliseconds(500);
  if (now < next_) return std::nullopt;
  for (Write& write : writes_) {
    if (write.state != ParameterWriteState::kWaiting || now < write.due) continue;
    const auto entry = reader.EntryOf(write.name);
    if (write.requests == kMaxWriteRequests || (!entry && reader.IsMissing(write.name))) {
      write.state =
          write.was_answered ? ParameterWriteState::kRefused : ParameterWriteState::kUnanswered;
      continue;
    }
    if (!entry) continue;
    ++write.requests;
    write.due = now + kPatience;
    next_ = now + kBetween;
    mavlink::ParamSet message;
    SetText(entry->name, message.param_id);
    message.param_type = entry->type;
    message.param_value = ParameterOnWire(kind, entry->type, write.value / entry->scale);
    return message;
  }
  return std::nullopt;
}

}  // namespace kestrel
