// SPDX-License-Identifier: BSD-3-Clause
// In place of Highway (https://github.com/google/highway) where there is none, or one before 1.0:
// what the kernels use of it, under the same names, for vectors of one lane. A vector is a number,
// a mask is a bool. The names mean what they mean there; KESTREL_USE_HIGHWAY chooses.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

// Targets that kernels ask for, with Highway's numbers.
#define HWY_AVX3_DL (1LL << 7)
#define HWY_AVX3 (1LL << 8)
#define HWY_AVX2 (1LL << 9)
#define HWY_SCALAR (1LL << 62)
#define HWY_TARGET HWY_SCALAR
#define HWY_NAMESPACE N_SCALAR
#define HWY_ONCE 1

#define HWY_ALIGN alignas(64)
#define HWY_ATTR
#define HWY_INLINE inline __attribute__((always_inline))
#define HWY_RESTRICT __restrict__

#define HWY_BEFORE_NAMESPACE() static_assert(true, "")
#define HWY_AFTER_NAMESPACE() static_assert(true, "")
#define HWY_EXPORT(function) static_assert(true, "")
#define HWY_DYNAMIC_DISPATCH(function) HWY_NAMESPACE::function

namespace hwy {

// For tests that run with one target after the other.
struct ChosenTarget {
  void Update(std::int64_t) {}
};
inline ChosenTarget GetChosenTarget() { return {}; }
inline std::vector<std::int64_t> SupportedAndGeneratedTargets() { return {HWY_TARGET}; }
inline std::int64_t SupportedTargets() { return HWY_TARGET; }
inline void SetSupportedTargetsForTest(std::int64_t) {}
inline const char* TargetName(std::int64_t) { return "one lane"; }

namespace HWY_NAMESPACE {

template <typename T>
struct OneLane {
  using Lane = T;
};
template <typename T>
using ScalableTag = OneLane<T>;
template <typename T, std::size_t kMost>
using CappedTag = OneLane<T>;
template <class D>
using Vec = typename D::Lane;
template <class D>
using Mask = bool;
template <class D>
using RebindToSigned = OneLane<std::int32_t>;

template <class D>
constexpr std::size_t Lanes(D) {
  return 1;
}
template <class D>
constexpr std::size_t MaxLanes(D) {
  return 1;
}

template <class D>
HWY_INLINE Vec<D> Set(D, Vec<D> value) {
  return value;
}
template <class D>
HWY_INLINE Vec<D> Zero(D) {
  return 0;
}
template <class D>
HWY_INLINE Vec<D> Load(D, const Vec<D>* from) {
  return *from;
}
template <class D>
HWY_INLINE Vec<D> LoadU(D, const Vec<D>* from) {
  return *from;
}
template <class D>
HWY_INLINE Vec<D> GatherIndex(D, const Vec<D>* from, std::int32_t index) {
  return from[index];
}
template <class D>
HWY_INLINE void Store(Vec<D> value, D, Vec<D>* to) {
  *to = value;
}
template <class D>
HWY_INLINE void StoreU(Vec<D> value, D, Vec<D>* to) {
  *to = value;
}
template <class V>
HWY_INLINE V GetLane(V value) {
  return value;
}
template <class D>
HWY_INLINE Vec<D> SumOfLanes(D, Vec<D> value) {
  return value;
}

template <class V>
HWY_INLINE V Add(V a, V b) {
  return a + b;
}
template <class V>
HWY_INLINE V Sub(V a, V b) {
  return a - b;
}
template <class V>
HWY_INLINE V Mul(V a, V b) {
  return a * b;
}
template <class V>
HWY_INLINE V Div(V a, V b) {
  return a / b;
}
template <class V>
HWY_INLINE V MulAdd(V a, V b, V c) {
  return a * b + c;
}
template <class V>
HWY_INLINE V MulSub(V a, V b, V c) {
  return a * b - c;
}
template <class V>
HWY_INLINE V NegMulAdd(V a, V b, V c) {
  return c - a * b;
}
template <class V>
HWY_INLINE V Neg(V a) {
  return -a;
}
template <class V>
HWY_INLINE V Abs(V a) {
  return std::abs(a);
}
template <class V>
HWY_INLINE V Sqrt(V a) {
  return std::sqrt(a);
}
template <class V>
HWY_INLINE V CopySign(V magnitude, V sign) {
  return std::copysign(magnitude, sign);
}
// The second where one is no number, as on x86.
template <class V>
HWY_INLINE V Min(V a, V b) {
  return a < b ? a : b;
}
template <class V>
HWY_INLINE V Max(V a, V b) {
  return a > b ? a : b;
}
template <class V>
HWY_INLINE V AverageRound(V a, V b) {
  return static_cast<V>((a + b + 1) >> 1);
}

template <class V>
HWY_INLINE bool Lt(V a, V b) {
  return a < b;
}
template <class V>
HWY_INLINE bool Le(V a, V b) {
  return a <= b;
}
template <class V>
HWY_INLINE bool Gt(V a, V b) {
  return a > b;
}
template <class V>
HWY_INLINE bool Ge(V a, V b) {
  return a >= b;
}
template <class V>
HWY_INLINE V And(V a, V b) {
  return a & b;
}
template <class V>
HWY_INLINE V Or(V a, V b) {
  return a | b;
}
HWY_INLINE bool Not(bool mask) { return !mask; }
template <class V>
HWY_INLINE V IfThenElse(bool mask, V yes, V no) {
  return mask ? yes : no;
}
template <class V>
HWY_INLINE V IfThenElseZero(bool mask, V yes) {
  return mask ? yes : V{0};
}
template <class V>
HWY_INLINE V IfThenZeroElse(bool mask, V no) {
  return mask ? V{0} : no;
}

template <int kBits, class V>
HWY_INLINE V ShiftRight(V a) {
  return static_cast<V>(a >> kBits);
}
template <class D, class V>
HWY_INLINE Vec<D> BitCast(D, V a) {
  return std::bit_cast<Vec<D>>(a);
}
template <class D, class V>
HWY_INLINE Vec<D> ConvertTo(D, V a) {
  return static_cast<Vec<D>>(a);
}

}  // namespace HWY_NAMESPACE
}  // namespace hwy
