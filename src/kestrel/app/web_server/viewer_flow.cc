// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/viewer_flow.h"

#include <algorithm>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "kestrel/core/base/bytes.h"

namespace kestrel {
namespace {

using Json = nlohmann::json;

constexpr char kMessageData = 1;
constexpr int kInfo = 0, kWarning = 1;

std::string Base64(const std::string& bytes) {
  namespace iterators = boost::archive::iterators;
  using Digits =
      iterators::base64_from_binary<iterators::transform_width<std::string::const_iterator, 6, 8>>;
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  const std::string whole = bytes + std::string(padding, '\0');
  std::string text(Digits(whole.begin()), Digits(whole.end()));
  std::fill_n(text.rbegin(), padding, '=');
  return text;
}

std::string StatusJson(int level, const std::string& text) {
  return Json{{"op", "status"}, {"level", level}, {"message", text}}.dump();
}

WebMessage DataMessage(std::uint32_t id, const ChannelMessage& message) {
  WebMessage data{std::string(1, kMessageData), message.content, false};
  Put(id, &data.head);
  Put(static_cast<std::uint64_t>(ToNanoseconds(message.time)), &data.head);
  return data;
}

}  // namespace

std::string ServerInfoJson(const std::string& name, const std::string& session) {
  return Json{
      {"op", "serverInfo"}, {"name", name}, {"capabilities", Json::array()}, {"sessionId", session}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string AdvertiseJson(const std::vector<LiveChannel>& channels) {
  Json list = Json::array();
  for (const LiveChannel& channel : channels) {
    list.push_back({{"id", list.size()},
                    {"topic", channel.topic},
                    {"encoding", channel.encoding},
                    {"schemaName", channel.schema_name},
                    {"schema", Base64(channel.schema)},
                    {"schemaEncoding", channel.schema_encoding}});
  }
  return Json{{"op", "advertise"}, {"channels", list}}.dump();
}

ViewerFlow::ViewerFlow(const std::vector<LiveChannel>* channels, std::size_t capacity)
    : channels_(channels), capacity_(capacity) {}

void ViewerFlow::Take(const ViewerRequest& request) {
  if (const auto* subscribe = std::get_if<SubscribeRequest>(&request)) {
    for (const ViewerSubscription& each : subscribe->subscriptions) Subscribe(each);
  } else if (const auto* unsubscribe = std::get_if<UnsubscribeRequest>(&request)) {
    for (const std::uint32_t id : unsubscribe->ids) Unsubscribe(id);
  } else {
    const std::string& what = std::get<OtherRequest>(request).what;
    Warn(fmt::format("'{}' is not done here: this is to look at only", what));
  }
}

void ViewerFlow::Subscribe(const ViewerSubscription& subscription) {
  const auto [id, channel] = subscription;
  if (channel >= channels_->size()) return Warn(fmt::format("there is no channel {}", channel));
  const bool is_known = std::any_of(ids_.begin(), ids_.end(),
                                    [id = id](const auto& each) { return each.second == id; });
  if (is_known) return Warn(fmt::format("there is a subscription {} already", id));
  if (!ids_.emplace(channel, id).second) {
    Warn(fmt::format("channel {} is subscribed to already", channel));
  }
}

void ViewerFlow::Unsubscribe(std::uint32_t id) {
  const auto found =
      std::find_if(ids_.begin(), ids_.end(), [id](const auto& each) { return each.second == id; });
  if (found == ids_.end()) return Warn(fmt::format("there is no subscription {}", id));
  images_.erase(found->first);
  ids_.erase(found);
}

std::uint64_t ViewerFlow::wanted() const {
  std::uint64_t channels = 0;
  for (const auto& [channel, id] : ids_) channels |= std::uint64_t{1} << channel;
  return channels;
}

void ViewerFlow::Offer(const ChannelMessage& message) {
  const auto subscription = ids_.find(message.channel);
  if (subscription == ids_.end()) return;
  if ((*channels_)[message.channel].is_image) {
    lost_images_ += images_.count(message.channel);
    images_[message.channel] = message;
  } else {
    Push(DataMessage(subscription->second, message));
  }
}

void ViewerFlow::Report(std::string text) { Push({std::move(text), nullptr, true}); }

void ViewerFlow::Push(WebMessage message) {
  if (waiting_.size() == capacity_) {
    waiting_.pop_front();
    ++lost_messages_;
  }
  waiting_.push_back(std::move(message));
}

void ViewerFlow::Warn(const std::string& text) { Report(StatusJson(kWarning, text)); }

void ViewerFlow::ReportLosses() {
  if (lost_messages_ + lost_images_ == 0) return;
  const auto images = std::exchange(lost_images_, 0);
  const auto messages = std::exchange(lost_messages_, 0);
  Report(StatusJson(messages > 0 ? kWarning : kInfo,
                    fmt::format("{} images and {} messages left out: the connection is too slow",
                                images, messages)));
}

std::optional<WebMessage> ViewerFlow::Pop() {
  if (!waiting_.empty()) {
    WebMessage message = std::move(waiting_.front());
    waiting_.pop_front();
    return message;
  }
  if (images_.empty()) return std::nullopt;
  const auto image = images_.begin();
  WebMessage message = DataMessage(ids_.at(image->first), image->second);
  images_.erase(image);
  return message;
}

}  // namespace kestrel
