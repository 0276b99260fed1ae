// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace kestrel {

// Properties that identify another's entity.
struct FastEntity {
  std::string gid;  // 16 bytes
  std::string user_data;
  // These are empty for a participant.
  std::string topic;
  std::string type;
  bool is_writer = false;
};

// The 16 bytes of a GUID_t of Fast DDS.
template <class Guid>
std::string GidOf(const Guid& guid) {
  const std::string prefix(reinterpret_cast<const char*>(guid.guidPrefix.value),
                           sizeof(guid.guidPrefix.value));
  return prefix + std::string(reinterpret_cast<const char*>(guid.entityId.value),
                              sizeof(guid.entityId.value));
}

// The discovered entities of others, in the order of discovery.
class FastEntities {
 public:
  std::vector<FastEntity> heard() const {
    const std::lock_guard lock(mutex_);
    return heard_;
  }
  void Add(FastEntity entity) {
    const std::lock_guard lock(mutex_);
    heard_.push_back(std::move(entity));
  }

 private:
  mutable std::mutex mutex_;
  std::vector<FastEntity> heard_;
};

}  // namespace kestrel
