// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/parameter_reader.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <iterator>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/parameter_names.h"

namespace kestrel {
namespace {

constexpr int kMaxParameterRequests = 5;

// Returns the shortest decimal number that is 'value' as a float: 0.3, not 0.30000001192, which
// is above a limit of 0.3.
double AsTyped(float value) {
  char text[32];
  const std::to_chars_result end = std::to_chars(std::begin(text), std::end(text), value);
  double typed = value;
  std::from_chars(std::begin(text), end.ptr, typed);
  return typed;
}

}  // namespace

std::string_view TextOf(std::span<const char> field) {
  return {field.data(),
          static_cast<std::size_t>(std::find(field.begin(), field.end(), '\0') - field.begin())};
}

void SetText(std::string_view text, std::span<char> field) {
  std::fill(field.begin(), field.end(), '\0');
  std::copy_n(text.begin(), std::min(text.size(), field.size()), field.begin());
}

double ParameterValue(AutopilotKind kind, const mavlink::ParamValue& message) {
  if (kind == AutopilotKind::kPx4 && message.param_type == mavlink::kParamInt32) {
    return std::bit_cast<std::int32_t>(message.param_value);
  }
  if (kind == AutopilotKind::kPx4 && message.param_type == mavlink::kParamUint32) {
    return std::bit_cast<std::uint32_t>(message.param_value);
  }
  return AsTyped(message.param_value);
}

float ParameterOnWire(AutopilotKind kind, std::uint8_t type, double value) {
  if (kind == AutopilotKind::kPx4 && type == mavlink::kParamInt32) {
    return std::bit_cast<float>(static_cast<std::int32_t>(std::lround(value)));
  }
  if (kind == AutopilotKind::kPx4 && type == mavlink::kParamUint32) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(std::lround(value)));
  }
  return static_cast<float>(value);
}

const ParameterReader::Parameter* ParameterReader::Get(std::string_view name) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const Parameter& entry) { return entry.name == name; });
  return found == parameters_.end() ? nullptr : &*found;
}

void ParameterReader::Start(Parameter* parameter) {
  parameter->is_wanted = true;
  parameter->requests = 0;
  parameter->requested = 0;
  parameter->due = {};
}

void ParameterReader::Want(std::string_view name) {
  for (Parameter& parameter : parameters_) {
    if (parameter.name == name) return Start(&parameter);
  }
  Parameter parameter;
  parameter.name = name;
  for (const ParameterNames::Name& known : NamesOf(name).names) {
    if (!known.name.empty()) parameter.names.push_back({std::string(known.name), known.scale});
  }
  parameters_.push_back(parameter);
}

std::optional<double> ParameterReader::Find(std::string_view name) const {
  const Parameter* parameter = Get(name);
  if (parameter == nullptr || !parameter->own) return std::nullopt;
  return parameter->value;
}

bool ParameterReader::IsMissing(std::string_view name) const {
  const Parameter* parameter = Get(name);
  return parameter != nullptr && !parameter->is_wanted && !parameter->own;
}

std::optional<ParameterReader::Entry> ParameterReader::EntryOf(std::string_view name) const {
  const Parameter* parameter = Get(name);
  if (parameter == nullptr || !parameter->own) return std::nullopt;
  return parameter->names[*parameter->own];
}

bool ParameterReader::is_done() const {
  return std::none_of(parameters_.begin(), parameters_.end(),
                      [](const Parameter& parameter) { return parameter.is_wanted; });
}

void ParameterReader::Handle(AutopilotKind kind, const mavlink::ParamValue& message) {
  const std::string_view name = TextOf(message.param_id);
  for (Parameter& parameter : parameters_) {
    for (std::size_t i = 0; i < parameter.names.size(); ++i) {
      Entry& entry = parameter.names[i];
      if (entry.name != name) continue;
      entry.type = message.param_type;
      parameter.own = i;
      parameter.value = entry.scale * ParameterValue(kind, message);
      parameter.is_wanted = false;
    }
  }
}

void ParameterReader::RequestAgain() {
  for (Parameter& parameter : parameters_) Start(&parameter);
}

std::string_view ParameterReader::Next(Time now) {
  constexpr Duration kBetween = std::chrono::milliseconds(50);
  constexpr Duration kPatience = std::chrono::seconds(1);
  if (now < next_) return {};
  for (Parameter& parameter : parameters_) {
    if (!parameter.is_wanted || now < parameter.due) continue;
    if (parameter.requests == kMaxParameterRequests) {
      parameter.is_wanted = false;
      continue;
    }
    const std::string_view name = parameter.names[parameter.requested].name;
    next_ = now + kBetween;
    // Requests all of its names one after the other, then gives the autopilot time to answer.
    if (++parameter.requested == parameter.names.size()) {
      parameter.requested = 0;
      ++parameter.requests;
      parameter.due = now + kPatience;
    }
    return name;
  }
  return {};
}

}  // namespace kestrel
