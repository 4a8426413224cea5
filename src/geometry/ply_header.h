// The header of a PLY file: which elements follow, with which properties.
#pragma once

#include "base/error.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
std::size_t ply_type_bytes(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type;                       ///< Of the scalar, or of a list's entries.
  std::optional<PlyType> count_type;  ///< Of the number in front of a list; none: a scalar.
  Location location;
};

struct PlyElement {
  std::string name;
  std::uint64_t count;  ///< As claimed.
  std::vector<PlyProperty> properties;
  Location location;

  const PlyProperty* find(std::string_view property) const;
  /// Of one row in a binary file, all lists being empty.
  std::size_t least_bytes() const;
  bool has_lists() const;
};

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyFormat format;
  std::vector<PlyElement> elements;
  Location end;             ///< Of `end_header`.
  std::size_t body_offset;  ///< Of the first byte behind the header.

  const PlyElement* find(std::string_view element) const;
};

/// Throws InputError with the line for whatever is not a PLY 1.0 header.
PlyHeader read_ply_header(const std::shared_ptr<const SourceFile>& source);

}  // namespace etendue
