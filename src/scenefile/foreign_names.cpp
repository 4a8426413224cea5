#include "scenefile/foreign_names.h"

#include <algorithm>
#include <iterator>

namespace etendue {
namespace {

struct Tag {
  std::string_view tag, hint;
};

constexpr Tag tags[]{
    {"rgb", "write <color name=\"...\" value=\"r, g, b\"/>: linear, Rec. 709, from 0 to 1 for reflectances"},
    {"srgb", "write <color name=\"...\" value=\"r, g, b\"/> with linear numbers, not those of sRGB"},
    {"spectrum", "colours have three channels here: write <color name=\"...\" value=\"r, g, b\"/>"},
    {"blackbody", "colours have three channels here: write <color name=\"...\" value=\"r, g, b\"/>"},
    {"ref", "there are no references: write the object out in each place that uses it"},
    {"include", "files cannot include others: copy the elements into this file"},
    {"default", "there are no variables: write the values out where $names stand"},
    {"alias", "there are no references: write the object out in each place that uses it"},
    {"path", "paths are relative to the scene file"},
    {"film", "width and height stand in <camera>, the filter is an <rfilter>; the output is named by -o"},
    {"sensor", "write <camera type=\"perspective\">"},
    {"light", "write <emitter>"},
    {"material", "write <bsdf>, inside the shape"},
    {"volume", "write <medium type=\"homogeneous\"> with sigmaA and sigmaS"},
    {"subsurface", "scattering below surfaces is not rendered"},
    {"instance", "there are no instances: write a <shape> for each"},
    {"animation", "nothing moves here: write one <transform>"},
    {"number", "write <float name=\"...\" value=\"...\"/>"},
    {"double", "write <float name=\"...\" value=\"...\"/>"},
    {"int", "write <integer name=\"...\" value=\"...\"/>"},
    {"bool", "write <boolean name=\"...\" value=\"...\"/>"},
    {"text", "write <string name=\"...\" value=\"...\"/>"},
    {"colour", "write <color name=\"...\" value=\"r, g, b\"/>"},
};

struct Name {
  std::string_view tags, type, hint;
};

constexpr std::string_view bsdf_tags = "bsdf brdf", light_tags = "emitter luminaire",
                           shape_tags = "shape mesh", integrator_tags = "integrator",
                           sampler_tags = "sampler", camera_tags = "camera";
constexpr Name foreign_names[]{
    {bsdf_tags, "matte", "use diffuse, with albedo for its reflectance"},
    {bsdf_tags, "lambertian", "use diffuse"},
    {bsdf_tags, "conductor", "use roughconductor, with a small alpha, or mirror"},
    {bsdf_tags, "metal", "use roughconductor"},
    {bsdf_tags, "glass", "use dielectric"},
    {bsdf_tags, "thindielectric", "there is no thin pane; use two faces of dielectric"},
    {bsdf_tags, "plastic", "use microfacet or roughsubstrate"},
    {bsdf_tags, "roughplastic", "use microfacet or roughsubstrate"},
    {bsdf_tags, "substrate", "use roughsubstrate"},
    {bsdf_tags, "coateddiffuse", "use roughsubstrate"},
    {bsdf_tags, "glossy", "use phong or microfacet"},
    {light_tags, "infinite", "use envmap for an image, constant for one radiance"},
    {light_tags, "environment", "use envmap for an image, constant for one radiance"},
    {light_tags, "distant", "use directional"},
    {light_tags, "pointlight", "use point"},
    {light_tags, "arealight", "use area, inside the shape that shines"},
    {light_tags, "diffuse", "use area, inside the shape that shines"},
    {shape_tags, "plymesh", "use ply"},
    {shape_tags, "trianglemesh", "write the triangles to an OBJ or PLY file"},
    {shape_tags, "serialized", "write the triangles to an OBJ or PLY file"},
    {shape_tags, "cube", "write the triangles to an OBJ or PLY file, or use six of rectangle"},
    {shape_tags, "cylinder", "write the triangles to an OBJ or PLY file"},
    {shape_tags, "quad", "use rectangle"},
    {integrator_tags, "volpath", "use path_mis"},
    {integrator_tags, "pathtracer", "use path_mis"},
    {integrator_tags, "volpathmis", "use path_mis"},
    {integrator_tags, "directlighting", "use light, or mis"},
    {sampler_tags, "stratified", "use sobol"},
    {sampler_tags, "halton", "use sobol"},
    {sampler_tags, "multijitter", "use sobol"},
    {sampler_tags, "ldsampler", "use sobol"},
    {sampler_tags, "zsobol", "use sobol"},
    {sampler_tags, "random", "use independent"},
    {camera_tags, "thinlens", "use perspective, with apertureRadius and focusDistance"},
    {camera_tags, "pinhole", "use perspective"},
};

constexpr std::string_view whole_paths =
    "here paths have no fixed end: take the key out to see all their light";
constexpr std::string_view in_file = "change the mesh file instead, or take the key out";
constexpr ForeignKey keys[]{
    {"integrator", "", "maxDepth", whole_paths, true},
    {"integrator", "", "maxdepth", whole_paths, true},
    {"integrator", "", "maxBounces", whole_paths, true},
    {"integrator", "", "depth", whole_paths, true},
    {"integrator", "", "hideEmitters", "lights are seen here; take the key out", true},
    {"integrator", "", "photonCount", "there are no photons here; take the key out", true},
    {"integrator", "", "photonRadius", "there are no photons here; take the key out", true},
    {"integrator", "", "rrDepth", "Russian roulette begins at the third vertex; no mean depends on it",
     false},
    {"integrator", "", "strictNormals", "shading and geometric sides always agree here", false},
    {"bsdf", "diffuse", "reflectance", "its name here is 'albedo'", false},
    {"bsdf", "diffuse", "kd", "its name here is 'albedo'", true},
    {"bsdf", "mirror", "albedo", "a mirror here reflects all light; for a tint use roughconductor", true},
    {"bsdf", "mirror", "reflectance", "a mirror here reflects all light; for a tint use roughconductor",
     true},
    {"bsdf", "mirror dielectric roughdielectric", "specularReflectance", "no tint is rendered here", true},
    {"bsdf", "dielectric roughdielectric", "specularTransmittance", "no tint is rendered here", true},
    {"bsdf", "dielectric roughdielectric", "reflectance", "no tint is rendered here", true},
    {"bsdf", "dielectric roughdielectric", "transmittance", "no tint is rendered here", true},
    {"bsdf", "dielectric roughdielectric", "ka", "no tint is rendered here", true},
    {"bsdf", "dielectric roughdielectric", "int_ior", "its name here is 'intIOR'", true},
    {"bsdf", "dielectric roughdielectric", "ext_ior", "its name here is 'extIOR'", true},
    {"bsdf", "dielectric roughdielectric", "eta", "its name here is 'intIOR', over that of 'extIOR'", true},
    {"bsdf", "microfacet", "ks", "here it is 1 - the largest channel of kd", true},
    {"bsdf", "roughconductor", "material", "state eta and k", true},
    {"bsdf", "roughconductor", "extEta", "state eta and k over the index of the outside", true},
    {"bsdf", "roughconductor roughdielectric microfacet roughsubstrate", "roughness",
     "its name here is 'alpha'", true},
    {"bsdf", "roughconductor roughdielectric microfacet roughsubstrate", "alphaU", "only one alpha is known",
     true},
    {"bsdf", "roughconductor roughdielectric microfacet roughsubstrate", "alphaV", "only one alpha is known",
     true},
    {"bsdf", "roughconductor roughdielectric microfacet roughsubstrate", "alpha_u", "only one alpha is known",
     true},
    {"bsdf", "roughconductor roughdielectric microfacet roughsubstrate", "alpha_v", "only one alpha is known",
     true},
    {"light", "area", "power", "state radiance: power / (pi area) where all directions shine alike", true},
    {"light", "area", "intensity", "state radiance, in W/(m^2 sr)", true},
    {"light", "area", "emission", "its name here is 'radiance'", true},
    {"light", "area", "L", "its name here is 'radiance'", true},
    {"light", "area", "irradiance", "state radiance: irradiance / pi where all directions shine alike", true},
    {"light", "", "scale", "multiply the radiance, intensity or power by it", true},
    {"light", "envmap", "gamma", "write the image linear, as EXR", true},
    {"light", "point spot", "radiance", "state intensity in W/sr, or power in W", true},
    {"light", "", "samplingWeight", "lights are chosen by --light-sampler; no mean depends on it", false},
    {"camera", "", "fovAxis", "fov is horizontal here: 2 atan(tan(fov / 2) width / height) of a vertical one",
     false},
    {"camera", "", "aspect", "pixels are square; choose width and height", true},
    {"camera", "", "lensRadius", "its name here is 'apertureRadius'", true},
    {"camera", "", "lensradius", "its name here is 'apertureRadius'", true},
    {"camera", "", "aperture", "its name here is 'apertureRadius'", true},
    {"camera", "", "focalDistance", "its name here is 'focusDistance'", true},
    {"camera", "", "focaldistance", "its name here is 'focusDistance'", true},
    {"camera", "", "focalLength", "state fov: 2 atan(18 mm / focalLength) of a 35 mm camera", true},
    {"camera", "", "shutterOpen", "nothing moves here; take the key out", false},
    {"camera", "", "shutterClose", "nothing moves here; take the key out", false},
    {"camera", "", "principalPointOffsetX", "the axis goes through the middle of the image", true},
    {"camera", "", "principalPointOffsetY", "the axis goes through the middle of the image", true},
    {"shape", "obj ply", "flipNormals", in_file, true},
    {"shape", "obj ply", "flip_normals", in_file, true},
    {"shape", "obj ply", "faceNormals", in_file, true},
    {"shape", "obj ply", "face_normals", in_file, true},
    {"shape", "obj ply", "maxSmoothAngle", in_file, true},
    {"shape", "obj ply", "flipTexCoords", in_file, true},
    {"shape", "obj ply", "flip_tex_coords", in_file, true},
    {"shape", "obj ply", "shapeIndex", in_file, true},
    {"shape", "sphere", "flipNormals", "its front is outside; use a mesh that is wound the other way", true},
    {"shape", "sphere", "flip_normals", "its front is outside; use a mesh that is wound the other way", true},
    {"shape", "rectangle disk", "flipNormals", "turn it over by a rotation in toWorld", true},
    {"shape", "rectangle disk", "flip_normals", "turn it over by a rotation in toWorld", true},
    {"texture", "", "uscale", "scale the coordinates in the mesh file", true},
    {"texture", "", "vscale", "scale the coordinates in the mesh file", true},
    {"texture", "", "uoffset", "shift the coordinates in the mesh file", true},
    {"texture", "", "voffset", "shift the coordinates in the mesh file", true},
    {"texture", "imagetexture image_texture", "gamma", "write the image linear, as EXR, or state raw", true},
    {"texture", "imagetexture image_texture", "scale", "scale the coordinates in the mesh file", true},
    {"texture", "imagetexture image_texture", "delta", "shift the coordinates in the mesh file", true},
    {"texture", "imagetexture image_texture", "filterType", "its name here is 'interpolation'", true},
    {"texture", "imagetexture image_texture", "wrapMode", "its name here is 'wrap'", true},
    {"texture", "checkerboard_color", "color0", "its name here is 'value1'", true},
    {"texture", "checkerboard_color", "color1", "its name here is 'value2'", true},
    {"medium", "", "sigmaT", "state sigmaA and sigmaS, whose sum it is", true},
    {"medium", "", "sigma_t", "state sigmaA and sigmaS, whose sum it is", true},
    {"medium", "", "sigma_a", "its name here is 'sigmaA'", true},
    {"medium", "", "sigma_s", "its name here is 'sigmaS'", true},
    {"medium", "", "albedo", "state sigmaA and sigmaS: albedo is sigmaS / (sigmaA + sigmaS)", true},
    {"medium", "", "scale", "multiply sigmaA and sigmaS by it", true},
    {"medium", "", "density", "multiply sigmaA and sigmaS by it", true},
    {"sampler", "", "seed", "the seed is --seed", false},
};

/// Whether `word` is one of those in `list`.
bool has_word(std::string_view list, std::string_view word) {
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(' ', begin), list.size());
    if (list.substr(begin, end - begin) == word) return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace

std::string foreign_tag_hint(std::string_view tag) {
  for (const Tag& known : tags)
    if (known.tag == tag) return std::string(known.hint);
  return {};
}

std::string foreign_plugin_hint(std::string_view tag, std::string_view type) {
  for (const Name& known : foreign_names)
    if (has_word(known.tags, tag) && known.type == type) return std::string(known.hint);
  return {};
}

const ForeignKey* find_foreign_key(std::string_view family, std::string_view type, std::string_view key) {
  const auto* found = std::find_if(std::begin(keys), std::end(keys), [&](const ForeignKey& known) {
    return known.key == key && has_word(known.families, family) &&
           (known.types.empty() || has_word(known.types, type));
  });
  return found == std::end(keys) ? nullptr : found;
}

}  // namespace etendue
