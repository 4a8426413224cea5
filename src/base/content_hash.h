// A hash that tells whether bytes are the same as others were, on another day or another machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace etendue {

/// XXH3, 64 bits (Y. Collet, xxHash): some GB/s; not against those who mean to deceive.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void add(const void* bytes, std::size_t count);
  std::uint64_t digest() const;  ///< Of all bytes added so far, however they were cut.

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace etendue
