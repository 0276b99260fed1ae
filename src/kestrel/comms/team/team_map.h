// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "kestrel/comms/team/team_message.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// The maps of a team's UAVs, merged by versions: the newest contents of each UAV, and each object
// in the state that they list. Merging is commutative, associative and idempotent: members that
// have heard the same hold the same, in whatever order and however often messages come. An object
// that newer contents do not list is gone, so that removals need no memory.
class TeamMap {
 public:
  struct Entry {
    std::uint64_t version = 0;
    MappedObject object;  // on the clock and in the world of its UAV
    Time on_air;          // time at which it was last sent or heard, on this computer's clock
  };
  struct Part {
    Contents contents;
    Time sent_at;  // time at which the contents were sent first, on this computer's clock: the
                   // earliest estimate
    // The objects that have come. If the contents list a newer version of an object, the old one
    // stays.
    std::map<std::int64_t, Entry> objects;
    std::uint64_t revision = 0;  // grows whenever contents or objects change here

    bool Has(std::int64_t id) const;  // true when the listed version is here
    // Returns the first 'max' objects that are listed and not here.
    std::vector<std::int64_t> Missing(std::size_t max) const;
  };

  // 'local': the present time, on this computer's clock. Beyond kMaxUavs, the last UAVs are left
  // out.
  void Merge(const PartMessage& message, Time local);

  // Null when nothing of the UAV's map was heard.
  const Part* Find(const UavKey& uav) const;
  const std::map<UavKey, Part>& parts() const { return parts_; }

 private:
  std::map<UavKey, Part> parts_;
};

}  // namespace kestrel
