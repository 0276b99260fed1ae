// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/socket_session.h"

#include <string>
#include <utility>

#include "kestrel/console/console_json.h"

namespace kestrel {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

// A browser sends acknowledgements and commands.
constexpr std::size_t kMaxMessageBytes = 16 * 1024;
constexpr int kMaxMessagesPerSecond = 500;
constexpr std::chrono::seconds kHandshakeTimeout(5);

}  // namespace

SocketSession::SocketSession(beast::tcp_stream stream, ConsoleHub* hub, std::shared_ptr<void> slot)
    : stream_(std::move(stream)),
      hub_(hub),
      slot_(std::move(slot)),
      messages_(hub->options().message_queue) {}

SocketSession::~SocketSession() { Close(); }

void SocketSession::Accept(const Request& request) {
  // The WebSocket has times of its own.
  beast::get_lowest_layer(stream_).expires_never();
  const Duration idle = DurationFromSeconds(hub_->options().idle_timeout_s);
  stream_.set_option(websocket::stream_base::timeout{kHandshakeTimeout, idle, true});
  stream_.read_message_max(kMaxMessageBytes);
  stream_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return;
    self->is_open_ = true;
    self->hub_->Join(self.get());
    self->Read();
  });
}

void SocketSession::Read() {
  stream_.async_read(received_, [self = shared_from_this()](beast::error_code error, std::size_t) {
    const Time now = Now();
    if (error || !self->stream_.got_text() || self->IsTooBusy(now)) return self->Close();
    const auto data = self->received_.cdata();
    self->Take({static_cast<const char*>(data.data()), data.size()}, now);
    self->received_.clear();
    if (self->is_open_) self->Read();
  });
}

// What is not understood ends the connection: the page, which is ours, does not send it.
void SocketSession::Take(std::string_view text, Time now) {
  const std::optional<ClientMessage> message = ParseClientMessage(text);
  if (!message) {
    hub_->CountRefusal();
    return Close();
  }
  if (const auto* ack = std::get_if<ImageAck>(&*message)) {
    images_.Acknowledged(ack->sequence, now);
    SendNext();
  } else if (const auto* wish = std::get_if<ImageWish>(&*message)) {
    images_.SetWanted(wish->wanted);
  } else if (const auto* request = std::get_if<ColorRequest>(&*message)) {
    hub_->Ask(*request);
  } else {
    hub_->Command(std::get<ConsoleCommand>(*message));
  }
}

bool SocketSession::IsTooBusy(Time now) {
  if (now - second_began_ >= std::chrono::seconds(1)) {
    second_began_ = now;
    received_in_second_ = 0;
  }
  if (++received_in_second_ <= kMaxMessagesPerSecond) return false;
  hub_->CountRefusal();
  return true;
}

void SocketSession::SendNext() {
  if (!is_open_ || on_its_way_) return;
  // In turn, so that neither keeps the other back where the link is slow.
  const auto send_image = [this] {
    if (!images_.wants_next()) return false;
    const auto image = hub_->images().NewestAfter(images_.seen(), Now());
    if (!image) return false;
    images_.Sent(*image);
    Write(image->message, /*is_text=*/false);
    return true;
  };
  if (!was_image_ && send_image()) return;
  if (const SharedMessage message = messages_.Pop()) return Write(message, /*is_text=*/true);
  send_image();
}

void SocketSession::Write(const SharedMessage& message, bool is_text) {
  on_its_way_ = message;
  was_image_ = !is_text;
  stream_.text(is_text);
  const auto buffer = boost::asio::buffer(*on_its_way_);
  stream_.async_write(buffer, [self = shared_from_this()](beast::error_code error, std::size_t) {
    self->on_its_way_.reset();
    if (error) return self->Close();
    self->SendNext();
  });
}

void SocketSession::PushLinkReport(int clients) {
  Push(std::make_shared<const std::string>(
      ToJson({messages_.dropped(), images_.count(), images_.draw_time(), clients})));
}

void SocketSession::Close() {
  if (!is_open_) return;
  is_open_ = false;
  hub_->Leave(this);
  beast::get_lowest_layer(stream_).close();
}

}  // namespace kestrel
