// Reads the XML of the Nori family into a SceneDesc.
#pragma once

#include "scenefile/scene_desc.h"

#include <filesystem>
#include <optional>

namespace etendue {

/// Reads a scene or test file (UTF-8, UTF-16, UTF-32 or declared ISO-8859-1; at most 256 MiB; 64 elements
/// deep). The dialect is, first of these: `dialect`; the attribute `dialect="..."` of the root; nori-2012
/// where the file has a <luminaire>; otherwise nori, the generation in use. <emitter> alone does not tell
/// nori from nori-eth, which has the other sign of film x: an ETH file has to say so. Throws InputError for
/// anything that is not well-formed or not of the format.
SceneDesc read_nori_xml(const std::filesystem::path& file, std::optional<Dialect> dialect = std::nullopt);

/// "nori-2012", "nori-eth", "nori"; throws InputError with the known names for any other.
Dialect dialect_from_name(std::string_view name);
std::string_view dialect_name(Dialect dialect);

}  // namespace etendue
