// The text of one value -> truth value, numbers, colour, matrix: all of it must be used, and errors point
// into it.
#pragma once

#include "base/color.h"
#include "base/error.h"
#include "base/transform.h"

#include <initializer_list>
#include <string_view>
#include <vector>

namespace etendue {

/// In all of these `where` is the place of the whole value; where it holds `text` byte for byte, messages
/// point at the wrong token, otherwise at the whole. Numbers are decimal, finite, and split by spaces and/or
/// single commas. All throw InputError.
bool parse_boolean(std::string_view text, const Location& where);  ///< "true" or "false", in capitals or not.
int parse_integer(std::string_view text, const Location& where);
double parse_real(std::string_view text, const Location& where);
/// As many as one of `counts`; any number of them but 0 where `counts` is empty.
std::vector<double> parse_reals(std::string_view text, const Location& where,
                                std::initializer_list<std::size_t> counts = {});
Colorf parse_color(std::string_view text, const Location& where);  ///< Three numbers, or one for grey.
/// Sixteen numbers, rows first, perhaps split by ';'. The last row must be 0 0 0 1.
Transform parse_matrix(std::string_view text, const Location& where);

}  // namespace etendue
