#include "scenefile/file_format.h"

#include <algorithm>
#include <iterator>

namespace etendue {
namespace {

using namespace std::string_view_literals;

struct Format {
  std::string_view mark, name;
};

constexpr Format by_first_bytes[]{
    {"BLENDER"sv, "a Blender file"},
    {"\x28\xb5\x2f\xfd"sv, "a file packed by Zstandard, as Blender saves its own"},
    {"\x1f\x8b"sv, "a file packed by gzip"},
    {"PK\x03\x04"sv, "a ZIP archive, as USDZ and 3MF files are"},
    {"PXR-USDC"sv, "a USD scene"},
    {"#usda"sv, "a USD scene"},
    {"glTF"sv, "a glTF scene"},
    {"Kaydara FBX"sv, "an FBX scene"},
    {"MZ"sv, "a program"},
    {"\x89PNG"sv, "a PNG image"},
    {"\xff\xd8\xff"sv, "a JPEG image"},
    {"\x76\x2f\x31\x01"sv, "an EXR image"},
    {"#?RADIANCE"sv, "a Radiance HDR image"},
    {"#version"sv, "a POV-Ray scene"},
    {"#include \""sv, "a POV-Ray scene"},
    {"#declare"sv, "a POV-Ray scene"},
    {"global_settings"sv, "a POV-Ray scene"},
    {"ply\n"sv, "a PLY mesh"},
    {"ply\r"sv, "a PLY mesh"},
};

/// The first word behind comments of '#' and '//'.
constexpr Format by_first_word[]{
    {"LookAt"sv, "a pbrt scene"},
    {"Camera"sv, "a pbrt scene"},
    {"Film"sv, "a pbrt scene"},
    {"Sampler"sv, "a pbrt scene"},
    {"Integrator"sv, "a pbrt scene"},
    {"PixelFilter"sv, "a pbrt scene"},
    {"WorldBegin"sv, "a pbrt scene"},
    {"AttributeBegin"sv, "a pbrt scene"},
    {"Scale"sv, "a pbrt scene"},
    {"Rotate"sv, "a pbrt scene"},
    {"Translate"sv, "a pbrt scene"},
    {"Transform"sv, "a pbrt scene"},
    {"ConcatTransform"sv, "a pbrt scene"},
    {"Include"sv, "a pbrt scene"},
    {"Option"sv, "a pbrt scene"},
    {"ColorSpace"sv, "a pbrt scene"},
    {"Renderer"sv, "a pbrt scene"},
    {"SurfaceIntegrator"sv, "a pbrt scene"},
    {"Shape"sv, "a pbrt scene"},
    {"MakeNamedMaterial"sv, "a pbrt scene"},
    {"Material"sv, "a pbrt scene"},
    {"camera"sv, "a POV-Ray scene"},
    {"light_source"sv, "a POV-Ray scene"},
    {"v"sv, "an OBJ mesh"},
    {"vn"sv, "an OBJ mesh"},
    {"vt"sv, "an OBJ mesh"},
    {"f"sv, "an OBJ mesh"},
    {"o"sv, "an OBJ mesh"},
    {"g"sv, "an OBJ mesh"},
    {"mtllib"sv, "an OBJ mesh"},
    {"usemtl"sv, "an OBJ mesh"},
    {"solid"sv, "an STL mesh"},
    {"newmtl"sv, "a library of materials of an OBJ mesh"},
};

constexpr std::string_view white_space_in_files = " \t\r\n";

std::string_view first_word(std::string_view text) {
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(white_space_in_files), text.size()));
    if (!text.starts_with('#') && !text.starts_with("//")) break;
    text.remove_prefix(std::min(text.find_first_of("\r\n"), text.size()));
  }
  return text.substr(0, text.find_first_of(white_space_in_files));
}

}  // namespace

std::string_view format_of_content(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF"sv)) bytes.remove_prefix(3);
  for (const Format& format : by_first_bytes)
    if (bytes.starts_with(format.mark)) return format.name;
  constexpr std::size_t reach = 1 << 16;  // A comment at the beginning may be long, but not endless.
  const std::string_view begin = bytes.substr(0, reach);
  const std::string_view word = first_word(begin);
  if (word.starts_with('{') && begin.find("\"asset\"") != std::string_view::npos) return "a glTF scene";
  if (word.starts_with("scene.") || word.starts_with("film.")) return "a LuxCore scene";
  const auto* format = std::find_if(std::begin(by_first_word), std::end(by_first_word),
                                    [&](const Format& known) { return known.mark == word; });
  return format == std::end(by_first_word) ? std::string_view() : format->name;
}

}  // namespace etendue
