// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/console_page.h"

#include <array>
#include <deque>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kestrel/app/console/image_channel.h"
#include "kestrel/app/console/messages/console_json.h"
#include "kestrel/app/console/telemetry_channel.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

constexpr std::size_t kEventsForNewcomers = 50;
constexpr Duration kReportInterval = std::chrono::milliseconds(500);
// Limits for making a file, and a clip.
constexpr Duration kExportTime = std::chrono::seconds(10);
constexpr Duration kClipTime = std::chrono::minutes(20);

class ConsolePage;

// The conversation with one browser.
class Browser final : public WebConversation {
 public:
  explicit Browser(ConsolePage* page);
  ~Browser() override;
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void Push(const SharedMessage& message) { messages_.Push(message); }
  void PushLinkReport(int clients);

  bool Take(std::string_view text, bool is_text, Time now) override;
  std::optional<WebMessage> Next(Time now) override;

 private:
  ConsolePage* page_;
  TelemetryChannel messages_;
  ImageFlow images_;
  bool was_image_ = false;
};

class ConsolePage final : public LivePage {
 public:
  ConsolePage(const ConsoleOptions& options, ConsoleFeed* feed)
      : feed_(feed),
        images_(feed, options.jpeg_quality, options.max_image_rate_hz),
        capacity_(static_cast<std::size_t>(options.message_queue)),
        hello_(std::make_shared<const std::string>(ToJson(feed->description()))) {}

  ConsoleFeed* feed() { return feed_; }
  ImageChannel& images() { return images_; }
  std::size_t capacity() const { return capacity_; }

  // Adds a browser and gives it the present state.
  void Join(Browser* browser);
  void Leave(Browser* browser);

  std::string title() const override { return feed_->description().title; }
  std::unique_ptr<WebConversation> Begin() override { return std::make_unique<Browser>(this); }
  void Tick(Time now) override;
  std::optional<Duration> TimeToExport(std::string_view path) const override;
  void Export(std::string_view path, std::function<void(const ExportAnswer&)> answer,
              std::function<bool()> is_wanted) override {
    feed_->Export({*ParseExportPath(path), std::move(answer), std::move(is_wanted)});
  }

 private:
  int clients() const { return static_cast<int>(browsers_.size()); }
  void Broadcast(const ConsoleUpdate& update);

  ConsoleFeed* feed_;
  ImageChannel images_;
  std::size_t capacity_;
  SharedMessage hello_;
  // The newest message of each kind except samples and ages, for browsers that join later.
  std::array<SharedMessage, std::variant_size_v<ConsoleUpdate>> newest_;
  std::deque<SharedMessage> events_;
  std::vector<Browser*> browsers_;
  Time reported_{};
};

void ConsolePage::Join(Browser* browser) {
  browsers_.push_back(browser);
  feed_->SetWatchers(clients());
  browser->Push(hello_);
  for (const SharedMessage& message : newest_) {
    if (message) browser->Push(message);
  }
  for (const SharedMessage& message : events_) browser->Push(message);
}

void ConsolePage::Leave(Browser* browser) {
  std::erase(browsers_, browser);
  feed_->SetWatchers(clients());
}

void ConsolePage::Tick(Time now) {
  while (const std::optional<ConsoleUpdate> update = feed_->TakeUpdate()) Broadcast(*update);
  if (now - reported_ < kReportInterval) return;
  for (Browser* browser : browsers_) browser->PushLinkReport(clients());
  reported_ = now;
}

void ConsolePage::Broadcast(const ConsoleUpdate& update) {
  // Values of the moment are not kept: a page that connects later needs the next ones.
  const bool is_fleeting =
      std::holds_alternative<ViewSample>(update) || std::holds_alternative<ConsoleSources>(update);
  if (is_fleeting && browsers_.empty()) return;
  const auto message = std::make_shared<const std::string>(ToJson(update));
  if (std::holds_alternative<SessionEvent>(update)) {
    events_.push_back(message);
    if (events_.size() > kEventsForNewcomers) events_.pop_front();
  } else if (!is_fleeting) {
    newest_[update.index()] = message;
  }
  for (Browser* browser : browsers_) browser->Push(message);
}

std::optional<Duration> ConsolePage::TimeToExport(std::string_view path) const {
  const std::optional<ExportRequest> request = ParseExportPath(path);
  const ConsoleFeed::Description& description = feed_->description();
  if (!request) return std::nullopt;
  if (!description.has_exports && !(description.has_colors && IsOfColors(*request))) {
    return std::nullopt;
  }
  return IsClip(*request) ? kClipTime : kExportTime;
}

Browser::Browser(ConsolePage* page) : page_(page), messages_(page->capacity()) {
  page_->Join(this);
}

Browser::~Browser() { page_->Leave(this); }

bool Browser::Take(std::string_view text, bool is_text, Time now) {
  if (!is_text) return false;
  const std::optional<ClientMessage> message = ParseClientMessage(text);
  if (!message) return false;
  if (const auto* ack = std::get_if<ImageAck>(&*message)) {
    images_.Acknowledged(ack->sequence, now);
  } else if (const auto* wish = std::get_if<ImageWish>(&*message)) {
    const std::optional<std::size_t> view = page_->images().FindView(wish->view);
    if (!view) return false;
    images_.SetWish(wish->is_wanted, *view, wish->is_held);
  } else if (const auto* request = std::get_if<ColorRequest>(&*message)) {
    page_->feed()->Request(*request);
  } else {
    page_->feed()->Command(std::get<ConsoleCommand>(*message));
  }
  return true;
}

std::optional<WebMessage> Browser::Next(Time now) {
  // Images and messages alternate, so that neither delays the other on a slow link.
  const auto next_image = [&]() -> std::optional<WebMessage> {
    const auto image = page_->images().NextFor(images_, now);
    if (!image) return std::nullopt;
    images_.Sent(*image);
    was_image_ = true;
    return WebMessage{"", image->message, /*is_text=*/false};
  };
  if (!was_image_) {
    if (auto image = next_image()) return image;
  }
  if (SharedMessage message = messages_.Pop()) {
    was_image_ = false;
    return WebMessage{"", std::move(message), /*is_text=*/true};
  }
  return next_image();
}

void Browser::PushLinkReport(int clients) {
  Push(std::make_shared<const std::string>(
      ToJson({messages_.dropped(), images_.count(), images_.draw_time(), clients})));
}

}  // namespace

WebServer ServeConsole(const ConsoleOptions& options, ConsoleFeed* feed,
                       std::span<const WebAsset> assets, ChannelFeed* channels) {
  return WebServer(options, std::make_unique<ConsolePage>(Checked(options), feed), assets,
                   channels);
}

}  // namespace kestrel
