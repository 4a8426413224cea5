// Text -> double, as every reader of numbers here understands it.
#pragma once

#include <charconv>

namespace etendue {

/// As std::from_chars, but what is nearer to 0 than a double can tell (1e-400) is 0 or the nearest subnormal
/// number, and no error. Whatever the locale, decimals take a point.
std::from_chars_result number_from_chars(const char* first, const char* last, double& value);

}  // namespace etendue
