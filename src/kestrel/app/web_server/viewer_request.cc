// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/viewer_request.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <limits>

#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

using Json = nlohmann::json;

// Parameters may hold objects in lists. No well-meant text is deeper.
constexpr int kMaxRequestDepth = 16;
constexpr std::size_t kMaxList = 256, kMaxName = 64;

std::optional<std::uint32_t> ReadNumber(const Json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto number = value.get<std::uint64_t>();
  if (number > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

std::optional<std::uint32_t> ReadField(const Json& object, const char* name) {
  if (!object.is_object() || !object.contains(name)) return std::nullopt;
  return ReadNumber(object[name]);
}

// The list with this name; null when there is none, or it is too long.
const Json* FindList(const Json& message, const char* name) {
  const auto list = message.find(name);
  const bool is_fine = list != message.end() && list->is_array() && list->size() <= kMaxList;
  return is_fine ? &*list : nullptr;
}

std::optional<ViewerRequest> ReadSubscribe(const Json& message) {
  const Json* const list = FindList(message, "subscriptions");
  if (list == nullptr) return std::nullopt;
  SubscribeRequest request;
  for (const Json& each : *list) {
    const auto id = ReadField(each, "id");
    const auto channel = ReadField(each, "channelId");
    if (!id || !channel) return std::nullopt;
    request.subscriptions.push_back({*id, *channel});
  }
  return request;
}

std::optional<ViewerRequest> ReadUnsubscribe(const Json& message) {
  const Json* const list = FindList(message, "subscriptionIds");
  if (list == nullptr) return std::nullopt;
  UnsubscribeRequest request;
  for (const Json& each : *list) {
    const auto id = ReadNumber(each);
    if (!id) return std::nullopt;
    request.ids.push_back(*id);
  }
  return request;
}

bool IsName(const std::string& text) {
  return !text.empty() && text.size() <= kMaxName &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c); });
}

}  // namespace

std::optional<ViewerRequest> ParseViewerText(std::string_view text) {
  bool is_too_deep = false;
  const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
    is_too_deep |= depth > kMaxRequestDepth;
    return depth <= kMaxRequestDepth;
  };
  const Json message = Json::parse(text, limit_depth, /*allow_exceptions=*/false);
  if (is_too_deep || !message.is_object()) return std::nullopt;
  const auto field = message.find("op");
  if (field == message.end() || !field->is_string()) return std::nullopt;
  const std::string op = field->get<std::string>();
  if (op == "subscribe") return ReadSubscribe(message);
  if (op == "unsubscribe") return ReadUnsubscribe(message);
  if (!IsName(op)) return std::nullopt;
  return OtherRequest{op};
}

std::optional<ViewerRequest> ParseViewerBytes(std::string_view bytes) {
  constexpr std::size_t kMessageHead = 5, kCallHead = 13;  // operation, and numbers of 4 bytes
  if (bytes.size() >= kMessageHead && bytes[0] == 1) return OtherRequest{"message"};
  if (bytes.size() >= kCallHead && bytes[0] == 2) return OtherRequest{"call"};
  return std::nullopt;
}

}  // namespace kestrel
