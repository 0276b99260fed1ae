// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/ros_sink.h"

#include <chrono>
#include <cstddef>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr std::size_t kFrames = 8;  // that wait for the network
constexpr Duration kReportPeriod = std::chrono::seconds(1);

void Publish(const Observation& observation, RosResults* results) {
  std::visit([&](const auto& seen) { results->Publish(observation.frame, seen); },
             observation.seen);
}

class RosWriter : public SinkWriter {
 public:
  RosWriter(std::shared_ptr<RosResults> results, std::function<void(const std::string&)> notify)
      : results_(std::move(results)), notify_(std::move(notify)) {}

  void Write(const Observation& observation, std::size_t /*waiting*/) override {
    Publish(observation, results_.get());
  }
  void Write(const FlightReport& report) override {
    const Time now = Now();
    if (now < next_report_ && !report.end) return;
    next_report_ = now + kReportPeriod;
    results_->Publish(report);
  }
  void Write(const TeamReport& report) override { results_->Publish(report); }
  void Finish(std::size_t dropped) override {
    results_->Flush();
    if (dropped == 0) return;
    notify_(fmt::format("ROS: {} frames are left out: the network is too slow", dropped));
  }

 private:
  std::shared_ptr<RosResults> results_;
  std::function<void(const std::string&)> notify_;
  Time next_report_ = Now();
};

class WaitingRosSink : public ObservationSink {
 public:
  explicit WaitingRosSink(std::unique_ptr<RosResults> results) : results_(std::move(results)) {
    results_->WaitForSubscribers(std::chrono::seconds(1));
  }

  void Take(const Observation& observation) override { Publish(observation, results_.get()); }
  void Take(const TeamReport& report) override { results_->Publish(report); }
  void Finish() override { results_->Flush(); }

 private:
  std::unique_ptr<RosResults> results_;
};

}  // namespace

std::unique_ptr<AsynchronousSink> MakeRosSink(std::shared_ptr<RosResults> results,
                                              std::function<void(const std::string&)> notify) {
  AsynchronousSinkOptions options{.thread_name = "ros", .frames = kFrames, .notify = {}};
  options.notify = [notify](const std::string& error) {
    notify(fmt::format("ROS: {}: the flight goes on without it", error));
  };
  return std::make_unique<AsynchronousSink>(
      std::move(options), std::make_unique<RosWriter>(std::move(results), std::move(notify)));
}

std::unique_ptr<ObservationSink> MakeWaitingRosSink(std::unique_ptr<RosResults> results) {
  return std::make_unique<WaitingRosSink>(std::move(results));
}

}  // namespace kestrel
