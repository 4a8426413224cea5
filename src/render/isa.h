// The instruction sets that kernels are built for, and which of them this machine has.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace etendue {

/// One lane of floats, or the x86-64 level: v2 SSE4.2 (4 lanes), v3 AVX2 (8), v4 AVX-512 (16).
enum class Isa { scalar, v2, v3, v4 };

std::string_view isa_name(Isa isa);  ///< "scalar", "v2", "v3", "v4".
/// Throws InputError with the known names for an unknown one, and where this machine lacks it.
Isa isa_from_name(std::string_view name);
std::vector<Isa> available_isas();  ///< What this machine can run, narrowest first; never empty.
int lane_count(Isa isa);

}  // namespace etendue
