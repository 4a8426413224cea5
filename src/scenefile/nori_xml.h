// Reads the XML of the Nori family into a SceneDesc.
#pragma once

#include <filesystem>
#include <optional>

#include "scenefile/scene_desc.h"

namespace etendue {

/// Reads a scene or test file. `dialect` overrides `dialect="..."` on the root, which overrides the rule of
/// docs/scene_format.md. Throws InputError for anything that is not well-formed or not of the format.
SceneDesc read_nori_xml(const std::filesystem::path& file, std::optional<Dialect> dialect = std::nullopt);

/// "nori-2012", "nori-eth", "nori"; throws InputError with the known names for any other.
Dialect dialect_from_name(std::string_view name);
std::string_view dialect_name(Dialect dialect);

}  // namespace etendue
