// The samples of a pixel in equal, alike parts, from whose spread its error is known.
#pragma once

#include "sampler/sampler.h"

#include <cstdint>
#include <string_view>

namespace etendue {

/// `block`: replicate r is the samples r n ... r n + n - 1 of the pixel's one sequence, so that all
/// replicates together are one well distributed set. `scrambling`: it has a sequence of its own.
enum class ReplicatesBy { block, scrambling };

/// Throws InputError with the known names.
ReplicatesBy replicates_by_from_name(std::string_view name);
std::string_view replicates_by_name(ReplicatesBy by);

/// The number of replicates where none is asked for: the smallest divisor of `samples_per_pixel` (at least 1)
/// that is at least 8 and at least 1/64 of it; below 8 samples all of them. Why: docs/conventions.md.
int default_replicates(int samples_per_pixel);

/// Where the samples of a replicate stand.
struct ReplicatePlace {
  std::uint64_t stream;       ///< Of sample_stream.
  std::uint32_t first_index;  ///< In the stream.
};
/// \param samples_per_replicate with ReplicatesBy::block, (replicate + 1) times it must not exceed 2^32
inline ReplicatePlace replicate_place(ReplicatesBy by, std::uint64_t seed, int x, int y,
                                      std::int64_t replicate, int samples_per_replicate) {
  if (by == ReplicatesBy::scrambling) return {sample_stream(seed, x, y, replicate), 0};
  return {sample_stream(seed, x, y, 0), std::uint32_t(replicate * samples_per_replicate)};
}

}  // namespace etendue
