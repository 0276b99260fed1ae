// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/flight/guidance/guidance.h"

namespace kestrel {

// The mark that a person has confirmed: without that the UAV does not fly to what is marked.
class Confirmation {
 public:
  // Nothing is confirmed; orders so far do not count.
  void Begin(const FollowOrder& order);
  // Takes a new order. One for another mark is void, and so is one that comes while the UAV cannot
  // fly to the mark: 'refusal' says why, nullptr where it can. Another mark ends a confirmation.
  // Returns why the UAV stops and waits for a person from now on, else nullptr. 'mark': the present
  // one.
  const char* Update(const FollowOrder& order, int mark, const char* refusal);
  void Withdraw() { mark_ = 0; }

  int mark() const { return mark_; }       // 0: none is confirmed
  bool is_new() const { return is_new_; }  // the last update has taken an order

 private:
  const char* Take(const FollowOrder& order, int mark, const char* refusal);

  int number_ = 0;  // of the newest order
  int mark_ = 0;
  bool is_new_ = false;
};

}  // namespace kestrel
