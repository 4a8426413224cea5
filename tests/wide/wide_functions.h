// Functions of the wide code by name, as a module of one instruction set exports them: arrays in, arrays out.
#pragma once

#include "scene/scene.h"

#include <cstddef>
#include <cstdint>

namespace etendue {

/// What a column of words holds.
enum class Words { floats, integers };

struct WideFunction {
  const char* name;
  int inputs, outputs;  ///< Columns of 32-bit words.
  Words output_words;
  /// `in[k][i]` is input k of element i; floats by their bits. `count` is a multiple of 16.
  void (*run)(const Scene& scene, const std::uint32_t* const* in, std::uint32_t* const* out, int count);
};

struct WideFunctions {
  const WideFunction* functions;
  std::size_t count;
};

}  // namespace etendue
