// What the readers of mesh files share: numbers, their errors, vectors in world space.
#pragma once

#include "base/error.h"
#include "base/vec.h"

#include <optional>
#include <string>
#include <string_view>

namespace etendue {

/// The file without a place in it, for what has no lines.
Location whole_file(const SourceFile& source);

/// The token where all of it is a finite number ("-1.5", "+2.", "1e-3").
std::optional<double> finite_number(std::string_view token);

struct NumberProblem {
  std::string problem, hint;
};
/// Why finite_number() refuses `token`.
NumberProblem number_problem(std::string_view token);

/// In quotes; long garbage is cut, and bytes that are not printable ASCII are shown as '?'.
std::string quoted(std::string_view token);

/// Unit, or zero where `n` has no direction that a double can hold.
Vec3f unit_or_zero(const Vec3<double>& n);

}  // namespace etendue
