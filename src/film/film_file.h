// A film in a file, exactly: to go on with a render, or to join its parts.
//
// All numbers are little-endian:
//   8 bytes  "ETDFILM\n"
//   u32      version of the format, 1
//   u32 u32  width and height, pixels
//   u64 u64  seed, scene hash
//   u64      samples a replicate
//   u8       how replicates are made: 0 block, 1 scrambling
//   5 times  u32 length and so many bytes of text: sampler, integrator, isa, dialect, software
//   u32      blocks; then for each block
//     u64 u64  its replicates [first, last)
//     for each pixel, rows from the top: i64 count, f64 mean (r, g, b), f64 M2 (r, g, b), f64 M3 (r, g, b)
//   u64      XXH3 of all bytes before
#pragma once

#include "film/film_stack.h"
#include "sampler/replicates.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace etendue {

/// What films must have in common to be parts of one.
struct FilmOrigin {
  std::uint64_t seed = 0, scene_hash = 0;
  std::int64_t samples_per_replicate = 1;  ///< Positive.
  ReplicatesBy replicates_by = ReplicatesBy::block;
  /// At most 64 KiB each. `integrator` says all of its rules, as describe does; `isa` and `dialect` are
  /// names.
  std::string sampler, integrator, isa, dialect, software;

  friend bool operator==(const FilmOrigin&, const FilmOrigin&) = default;
};

struct FilmState {
  FilmOrigin origin;
  FilmStack film;  ///< As committed; every pixel has all replicates.
};

/// The whole file or none. Throws InputError with the path and the reason, also for a fragment: a film
/// without replicates, or with pixels that lack some.
void write_film(const std::filesystem::path& file, const FilmState& state);

/// Throws InputError for a file that is not a film, of another version, cut short or damaged, with which of
/// these it is; never allocates more than a file of that size can hold.
FilmState read_film(const std::filesystem::path& file);

}  // namespace etendue
