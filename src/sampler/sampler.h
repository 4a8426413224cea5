// Random numbers as a pure function of (seed, pixel, scrambling, index, dimension).
//
// To add a sampler: give it a SamplerKind, its name and its plugin description in sampler.cpp, and its case
// in sample_2d, a file of its own for its points; add it to docs/scene_format.md and to
// tests/statistical/sampler_test.cpp.
#pragma once

#include "base/hash.h"
#include "base/simd_math.h"
#include "base/vec.h"
#include "sampler/sobol.h"
#include "scenefile/parameters.h"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace etendue {

/// `independent`: uncorrelated numbers. `sobol`: Owen-scrambled Sobol points, one scrambling a stream.
enum class SamplerKind { independent, sobol };

const std::vector<Plugin>& sampler_plugins();
/// Throws InputError with the known names.
SamplerKind sampler_from_name(std::string_view name);
std::string_view sampler_name(SamplerKind kind);

/// Pairs of dimensions, by consumer. A consumer has the same pair in every integrator, so that integrators
/// can be compared sample by sample. `choice` serves what a path decides on its way: Russian roulette and the
/// length of its free flight.
namespace dimension {
inline constexpr std::uint32_t film = 0, light = 1, bsdf = 2, choice = 3;
inline constexpr std::uint32_t vertex_stride = 4;
/// Which candidate of a light sample is kept; out of the way of the pairs above at any vertex.
inline constexpr std::uint32_t selection = 0x20000000;
/// Out of the way of any path's vertices.
inline constexpr std::uint32_t lens = 0x40000000, outline_film = 0x60000000, outline_lens = 0x60000001;

/// The pair of a consumer at a vertex of a path; vertex 0 is what the camera sees.
constexpr std::uint32_t at_vertex(std::uint32_t pair, std::uint32_t vertex) {
  return pair + vertex_stride * vertex;
}
}  // namespace dimension

/// The 64-bit key of one sequence of samples; its halves seed the lanes. A pixel has one for each scrambling,
/// number 0 where its replicates are blocks of one.
inline std::uint64_t sample_stream(std::uint64_t seed, int x, int y, std::int64_t scrambling) {
  return hash64(hash64(hash64(seed) ^ std::uint64_t(scrambling)) ^ (std::uint64_t(std::uint32_t(y)) << 32) ^
                std::uint32_t(x));
}

/// Two times 32 uniform random bits for each lane.
/// \param stream_lo,stream_hi the halves of `sample_stream`
/// \param index of the sample in the stream
template <class F>
Vec2<UInt<F>> sample_2d(SamplerKind kind, const UInt<F>& stream_lo, const UInt<F>& stream_hi,
                        const UInt<F>& index, std::uint32_t pair) {
  using U = UInt<F>;
  const U seed_index = hash32(stream_lo + U(pair * 0x9e3779b9u));
  const U seed_x = hash32(stream_hi + U(pair * 0x85ebca6bu));
  if (kind == SamplerKind::independent) {
    const U x = hash32(hash32(index ^ seed_index) + seed_x);
    return {x, hash32(x ^ hash32(seed_x + index * U(0xc2b2ae35u)))};
  }
  // The third seed needs only to be independent of each of the others, not hashed again.
  return owen_sobol_2d(index, seed_index, seed_x, seed_x + seed_index);
}

template <class F>
Vec2<F> to_unit_floats(const Vec2<UInt<F>>& bits) {
  return {to_unit_float(bits.x), to_unit_float(bits.y)};
}

}  // namespace etendue
