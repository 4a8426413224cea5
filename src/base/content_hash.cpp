#include "base/content_hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace etendue {

struct ContentHash::State {
  XXH3_state_t xxh3;
};

ContentHash::ContentHash() : state_(new State) { XXH3_64bits_reset(&state_->xxh3); }

ContentHash::~ContentHash() = default;

void ContentHash::add(const void* bytes, std::size_t count) {
  XXH3_64bits_update(&state_->xxh3, bytes, count);
}

std::uint64_t ContentHash::digest() const { return XXH3_64bits_digest(&state_->xxh3); }

}  // namespace etendue
