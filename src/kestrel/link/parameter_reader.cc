// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/link/parameter_reader.h"

#include <algorithm>
#include <cstring>

#include "kestrel/link/mavlink_enums.h"

namespace kestrel {
namespace {

constexpr int kMaxParameterRequests = 5;

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
    std::int32_t value = 0;
    std::memcpy(&value, &message.param_value, sizeof(value));
    return value;
  }
  if (kind == AutopilotKind::kPx4 && message.param_type == mavlink::kParamUint32) {
    std::uint32_t value = 0;
    std::memcpy(&value, &message.param_value, sizeof(value));
    return value;
  }
  return message.param_value;
}

const ParameterReader::Parameter* ParameterReader::Get(std::string_view name) const {
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const Parameter& entry) { return entry.name == name; });
  return found == parameters_.end() ? nullptr : &*found;
}

void ParameterReader::Want(std::string_view name) {
  for (Parameter& parameter : parameters_) {
    if (parameter.name != name) continue;
    parameter.is_wanted = true;
    parameter.requests = 0;
    parameter.due = {};
    return;
  }
  Parameter parameter;
  parameter.name = name;
  parameters_.push_back(parameter);
}

std::optional<double> ParameterReader::Find(std::string_view name) const {
  const Parameter* parameter = Get(name);
  return parameter != nullptr ? parameter->value : std::nullopt;
}

bool ParameterReader::IsMissing(std::string_view name) const {
  const Parameter* parameter = Get(name);
  return parameter != nullptr && !parameter->is_wanted && !parameter->value;
}

bool ParameterReader::is_done() const {
  return std::none_of(parameters_.begin(), parameters_.end(),
                      [](const Parameter& parameter) { return parameter.is_wanted; });
}

void ParameterReader::Handle(AutopilotKind kind, const mavlink::ParamValue& message) {
  const std::string_view name = TextOf(message.param_id);
  for (Parameter& parameter : parameters_) {
    if (parameter.name != name) continue;
    parameter.value = ParameterValue(kind, message);
    parameter.is_wanted = false;
  }
}

void ParameterReader::AskAgain() {
  for (Parameter& parameter : parameters_) {
    parameter.is_wanted = true;
    parameter.requests = 0;
    parameter.due = {};
  }
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
    ++parameter.requests;
    parameter.due = now + kPatience;
    next_ = now + kBetween;
    return parameter.name;
  }
  return {};
}

}  // namespace kestrel
