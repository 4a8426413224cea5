// A growing table read by lane-varying index, fast while it is short.
#pragma once

#include "base/gather.h"

#include <vector>

namespace etendue {

/// While it has no more entries than a packet has lanes, the whole table is one register, and a look-up is a
/// permutation (one cycle a packet) instead of a gather (one a lane).
template <class T>
class LookupTable {
 public:
  void push_back(const T& value) {
    values_.resize(std::size_t(size_) + 1 + widest_lanes);
    values_[std::size_t(size_++)] = value;
  }
  void set(std::int32_t i, const T& value) { values_[std::size_t(i)] = value; }
  std::int32_t size() const { return size_; }
  const T& operator[](std::int32_t i) const { return values_[std::size_t(i)]; }

  T at(std::int32_t index) const { return values_[std::size_t(index)]; }
  template <class A>
  xsimd::batch<T, A> at(const xsimd::batch<std::int32_t, A>& index) const {
#if defined(__AVX512F__)
    if (size_ <= 16) {
      if constexpr (std::is_same_v<T, float>)
        return xsimd::batch<T, A>(_mm512_permutexvar_ps(index.data, _mm512_loadu_ps(values_.data())));
      else
        return xsimd::batch<T, A>(_mm512_permutexvar_epi32(index.data, _mm512_loadu_si512(values_.data())));
    }
#elif defined(__AVX2__)
    if (size_ <= 8) {
      if constexpr (std::is_same_v<T, float>)
        return xsimd::batch<T, A>(_mm256_permutevar8x32_ps(_mm256_loadu_ps(values_.data()), index.data));
      else
        return xsimd::batch<T, A>(_mm256_permutevar8x32_epi32(
            _mm256_loadu_si256(reinterpret_cast<const __m256i*>(values_.data())), index.data));
    }
#endif
    return gather(values_.data(), index);
  }

 private:
  std::vector<T> values_;
  std::int32_t size_ = 0;
};

}  // namespace etendue
