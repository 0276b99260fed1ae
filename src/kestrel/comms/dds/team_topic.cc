// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/dds/team_topic.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <dds/dds.h>
#include <vector>

#include <fmt/format.h>

#include "kestrel/comms/dds/dds_domain.h"
#include "kestrel/comms/dds/opened_domain.h"
#include "kestrel/core/base/error.h"
#include "team_sample.h"

namespace kestrel {
namespace {

using Sample = kestrel_msg_dds__TeamSample_;
constexpr std::size_t kMaxBytes = 16400;
constexpr int kHistory = 64;  // messages of one sender that wait for a slow reader

dds_entity_t Require(dds_entity_t entity, int domain, const char* what) {
  if (entity >= 0) return entity;
  throw InputError(fmt::format("DDS domain {}: no {}: {}", domain, what, dds_strretcode(-entity)));
}

}  // namespace

struct TeamTopic::Entities {
  Entities(int domain, const std::string& team)
      : opened(OpenDdsDomain(domain)),
        participant(Require(dds_create_participant(domain, nullptr, nullptr), domain,
                            "participant (is there a network?)")) {
    try {
      const std::string name = "kestrel/team/" + team;
      const dds_entity_t topic =
          Require(dds_create_topic(participant, &kestrel_msg_dds__TeamSample__desc, name.c_str(),
                                   nullptr, nullptr),
                  domain, "topic");
      const std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)> qos(dds_create_qos(),
                                                                      dds_delete_qos);
      dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kHistory);
      dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
      // Kestrel's own reader requests only best effort: the digests find what is lost, and a UAV
      // that has it sends it. Repetitions by DDS would come in addition, and late.
      dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
      reader = Require(dds_create_reader(participant, topic, qos.get(), nullptr), domain, "reader");
      // Others may request everything.
      dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, 0);
      dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
      dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                                  DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
      dds_qset_writer_data_lifecycle(qos.get(), false);
      writer = Require(dds_create_writer(participant, topic, qos.get(), nullptr), domain, "writer");
    } catch (...) {
      dds_delete(participant);
      throw;
    }
  }
  ~Entities() { dds_delete(participant); }
  Entities(const Entities&) = delete;
  Entities& operator=(const Entities&) = delete;

  std::shared_ptr<const void> opened;
  dds_entity_t participant;
  dds_entity_t reader = 0;
  dds_entity_t writer = 0;
  std::string sender;
};

TeamTopic::TeamTopic(int domain, const std::string& team, const std::string& sender) {
  entities_ = std::make_unique<Entities>(DdsDomain(domain), team);
  entities_->sender = sender;
}

TeamTopic::~TeamTopic() = default;

void TeamTopic::Send(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMaxBytes) return;
  std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  Sample sample{};
  entities_->sender.copy(sample.sender, sizeof sample.sender - 1);
  sample.bytes._buffer = copy.data();
  sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(copy.size());
  // A message that cannot be written is lost, as on the air; the digests find it.
  static_cast<void>(dds_write(entities_->writer, &sample));
}

void TeamTopic::Receive(const std::function<void(std::span<const std::uint8_t>)>& hear) {
  constexpr std::size_t kAtOnce = 32;
  for (;;) {
    std::array<void*, kAtOnce> samples{};
    std::array<dds_sample_info_t, kAtOnce> infos{};
    const int count = dds_take(entities_->reader, samples.data(), infos.data(), kAtOnce, kAtOnce);
    if (count <= 0) return;
    for (int i = 0; i < count; ++i) {
      if (!infos[i].valid_data) continue;
      const auto& bytes = static_cast<const Sample*>(samples[i])->bytes;
      hear({bytes._buffer, bytes._length});
    }
    dds_return_loan(entities_->reader, samples.data(), count);
  }
}

}  // namespace kestrel
