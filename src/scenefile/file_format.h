// What a file is by its content, to name those that are something else than was expected.
#pragma once

#include <string_view>

namespace etendue {

/// The format that the first bytes of a file show: "a pbrt scene", "a PLY mesh" ...; empty where they show
/// none of the known ones. The XML of the Nori family and of Mitsuba is not among them.
std::string_view format_of_content(std::string_view bytes);

}  // namespace etendue
