// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/confirmation.h"

namespace kestrel {

void Confirmation::Begin(const FollowOrder& order) {
  number_ = order.number;
  mark_ = 0;
  is_new_ = false;
}

const char* Confirmation::Update(const FollowOrder& order, int mark, const char* refusal) {
  is_new_ = order.number != number_;
  if (is_new_) return Take(order, mark, refusal);
  if (mark_ == 0 || mark_ == mark) return nullptr;
  mark_ = 0;
  return "something else is marked: needs a confirmation";
}

const char* Confirmation::Take(const FollowOrder& order, int mark, const char* refusal) {
  number_ = order.number;
  mark_ = 0;
  if (order.mark == 0) return "was stopped: needs a new confirmation";
  if (order.mark != mark) return "refused: something else is marked now";
  if (refusal != nullptr) return refusal;
  mark_ = mark;
  return nullptr;
}

}  // namespace kestrel
