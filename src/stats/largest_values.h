// The largest of many values, by which the tail of their distribution is known.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace etendue {

/// Of values that are not negative, up to `most`; which these are does not depend on the order of adding.
class LargestValues {
 public:
  static constexpr std::size_t most = 1000;

  /// A value must exceed this to be among them.
  float threshold() const { return values_.size() < most ? 0 : values_.front(); }
  void add(float value) {
    if (!(value > threshold())) return;
    if (values_.size() == most) {
      std::pop_heap(values_.begin(), values_.end(), std::greater<>());
      values_.pop_back();
    }
    values_.push_back(value);
    std::push_heap(values_.begin(), values_.end(), std::greater<>());
  }
  void add(const LargestValues& others) {
    for (const float value : others.values_) add(value);
    count_ += others.count_;
  }
  /// So many values above 0 there were in all: the others stay below the threshold.
  void count(std::int64_t positive) { count_ += positive; }
  std::int64_t count() const { return count_; }
  /// In no order.
  const std::vector<float>& values() const { return values_; }

 private:
  std::int64_t count_ = 0;
  std::vector<float> values_;  ///< A heap with the least in front.
};

}  // namespace etendue
