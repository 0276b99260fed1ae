// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/web_server.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <sys/resource.h>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "kestrel/app/web_server/http_session.h"
#include "kestrel/app/web_server/web_hub.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/thread_setup.h"

namespace kestrel {
namespace {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;

// Intervals of the checks for new data. While somebody watches the interval adds to the image's
// age; while nobody does, the checks only keep what newcomers will get.
constexpr std::chrono::milliseconds kWatchedInterval(4), kUnwatchedInterval(100);
// The threads that fly have priority.
constexpr int kNiceness = 10;

Tcp::acceptor Listen(asio::io_context& context, const ConsoleOptions& options) {
  const Tcp::endpoint endpoint(asio::ip::make_address(options.address),
                               static_cast<unsigned short>(options.port));
  try {
    return Tcp::acceptor(context, endpoint);
  } catch (const boost::system::system_error& error) {
    throw InputError(fmt::format(
        "console: cannot listen at {} port {} ({}), expected a free port of this computer",
        options.address, options.port, error.code().message()));
  }
}

std::string HostOf(const asio::ip::address& address) {
  return address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
}

}  // namespace

class WebServer::Impl {
 public:
  Impl(const ConsoleOptions& options, std::unique_ptr<LivePage> page,
       std::span<const WebAsset> assets, ChannelFeed* channels)
      : options_(WithToken(Checked(options))),
        page_(std::move(page)),
        acceptor_(Listen(context_, options_)),
        timer_(context_),
        port_(acceptor_.local_endpoint().port()) {
    hub_ = std::make_unique<WebHub>(options_, page_.get(), assets, port_, channels);
    Accept();
    Tick();
    thread_ = std::thread([this] { Serve(); });
  }

  ~Impl() {
    context_.stop();
    thread_.join();
  }

  int port() const { return port_; }
  const WebHub& hub() const { return *hub_; }

  std::string Url(std::string_view scheme, std::string_view path) const {
    const auto address = acceptor_.local_endpoint().address();
    return Url(scheme, address.is_unspecified() ? "localhost" : HostOf(address), path);
  }

  std::vector<std::string> Urls() const {
    std::vector<std::string> urls = {Url("http", "/")};
    if (!acceptor_.local_endpoint().address().is_unspecified()) return urls;
    for (const std::string& host : OwnAddresses()) urls.push_back(Url("http", host, "/"));
    if (urls.size() > 1) urls.push_back(Url("http", OwnHostName() + ".local", "/"));
    return urls;
  }

 private:
  std::string Url(std::string_view scheme, const std::string& host, std::string_view path) const {
    const std::string query = options_.token.empty() ? "" : "?token=" + options_.token;
    return fmt::format("{}://{}:{}{}{}", scheme, host, port_, path, query);
  }

  void Serve() {
    SetUpThisThread("console", {});
    // On Linux this concerns this thread only. Where it is not permitted the server runs all the
    // same.
    setpriority(PRIO_PROCESS, 0, kNiceness);
    context_.run();
  }

  void Accept() {
    acceptor_.async_accept([this](boost::system::error_code error, Tcp::socket socket) {
      if (error) return AcceptLater();
      if (auto slot = hub_->TakeSlot()) {
        socket.set_option(Tcp::no_delay(true), error);
        std::make_shared<HttpSession>(std::move(socket), hub_.get(), std::move(slot))->Read();
      }
      Accept();
    });
  }

  // Accepting fails when there are no more file descriptors; it is tried again later.
  void AcceptLater() {
    const auto wait = std::make_shared<asio::steady_timer>(context_, kUnwatchedInterval);
    wait->async_wait([this, wait](boost::system::error_code) { Accept(); });
  }

  void Tick() {
    hub_->Tick(Now());
    timer_.expires_after(hub_->has_clients() ? kWatchedInterval : kUnwatchedInterval);
    timer_.async_wait([this](boost::system::error_code error) {
      if (!error) Tick();
    });
  }

  ConsoleOptions options_;
  std::unique_ptr<LivePage> page_;
  // Declared before the context: the connections are destroyed with it, and then leave the hub.
  std::unique_ptr<WebHub> hub_;
  asio::io_context context_{1};
  Tcp::acceptor acceptor_;
  asio::steady_timer timer_;
  int port_;
  std::thread thread_;
};

WebServer::WebServer(const ConsoleOptions& options, std::unique_ptr<LivePage> page,
                     std::span<const WebAsset> assets, ChannelFeed* channels)
    : impl_(std::make_unique<Impl>(options, std::move(page), assets, channels)) {}

WebServer::~WebServer() = default;
WebServer::WebServer(WebServer&& other) noexcept = default;

int WebServer::port() const { return impl_->port(); }

std::vector<std::string> WebServer::urls() const { return impl_->Urls(); }

std::string WebServer::viewer_url() const { return impl_->Url("ws", kViewerPath); }

WebServer::Counters WebServer::counters() const {
  const WebHub& hub = impl_->hub();
  return {hub.connections(), hub.refused(), hub.sockets() - hub.viewers(), hub.viewers()};
}

}  // namespace kestrel
