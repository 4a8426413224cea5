#include "scenefile/mtl_reader.h"

#include "scenefile/existing_file.h"
#include "scenefile/file_format.h"
#include "scenefile/obj_cursor.h"
#include "scenefile/text_file.h"
#include "scenefile/value_text.h"
#include "scenefile/whole_file.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <string_view>
#include <utility>

namespace etendue {
namespace {

/// A word or more of the file, and where they stand.
struct Words {
  std::string_view text;
  Location where;
};

struct StatedColor {
  Colorf value;
  Location where;
};

/// The statements of one material that mean something here.
struct MaterialStatements {
  std::string name;
  Location where;
  std::optional<StatedColor> kd, ks, ke;
  std::optional<std::pair<double, Location>> ns;
  std::optional<Words> map_kd;
  bool is_clamped = false;  ///< map_Kd
  int illum = 2;
};

/// What is said once a file, however many materials it is true of.
class Remarks {
 public:
  void add(const Location& where, std::string_view problem, std::string_view hint) {
    for (Remark& known : all_)
      if (known.problem == problem) {
        ++known.count;
        return;
      }
    all_.push_back({where, problem, hint});
  }

  std::vector<std::string> messages() const {
    std::vector<std::string> said;
    for (const Remark& r : all_)
      said.push_back(format_message(
          r.first, r.count == 1 ? std::string(r.problem) : fmt::format("{} ({} times)", r.problem, r.count),
          r.hint));
    return said;
  }

 private:
  struct Remark {
    Location first;
    std::string_view problem, hint;
    std::size_t count = 1;
  };
  std::vector<Remark> all_;
};

constexpr std::string_view take_it_out =
    "take such a material out of the MTL file, and its faces have the bsdf that stands in the mesh; or give "
    "each "
    "material a mesh of its own, by 'usemtl'";

/// The options of a map, by the number of words behind each at most; fewer are numbers.
struct MapOption {
  std::string_view name;
  int most_values;
};
constexpr std::array<MapOption, 13> map_options{{{"-blendu", 1},
                                                 {"-blendv", 1},
                                                 {"-boost", 1},
                                                 {"-bm", 1},
                                                 {"-cc", 1},
                                                 {"-clamp", 1},
                                                 {"-imfchan", 1},
                                                 {"-mm", 2},
                                                 {"-o", 3},
                                                 {"-s", 3},
                                                 {"-t", 3},
                                                 {"-texres", 1},
                                                 {"-type", 1}}};

class MtlReader {
 public:
  MtlReader(std::filesystem::path directory, std::filesystem::path name,
            std::shared_ptr<const SourceFile> source)
      : directory_(std::move(directory)),
        name_(std::move(name)),
        source_(std::move(source)),
        cursor_(source_->text, 0) {}

  MtlLibrary read() {
    cursor_.accept('\xEF') && cursor_.accept('\xBB') && cursor_.accept('\xBF');  // the byte order mark
    for (; !cursor_.at_end(); cursor_.skip_line()) {
      cursor_.skip_blanks();
      if (!cursor_.at_statement_end()) read_statement();
    }
    if (current_) finish(*current_);
    if (library_.materials.empty())
      throw InputError(Location{source_}, "no material", "expected an MTL file: newmtl, Kd and the like");
    if (!passed_over_.empty())
      library_.warnings.push_back(format_message(
          passed_over_where_,
          fmt::format("what is not rendered of these materials: {}", fmt::join(passed_over_, ", ")),
          "rendered are Kd, map_Kd, Ks, Ns and Ke"));
    for (std::string& message : remarks_.messages()) library_.warnings.push_back(std::move(message));
    return std::move(library_);
  }

 private:
  Words take(std::string_view (ObjCursor::*part)()) {
    cursor_.skip_blanks();
    const std::size_t offset = cursor_.offset();
    const std::string_view text = (cursor_.*part)();
    return {text, {source_, offset, std::max<std::size_t>(text.size(), 1)}};
  }
  Words take_word() { return take(&ObjCursor::take_token); }
  Words take_rest() { return take(&ObjCursor::take_rest); }

  void read_statement() {
    const Words key = take_word();
    if (key.text == "newmtl") {
      begin(key);
      return;
    }
    if (!current_)
      throw InputError(key.where, fmt::format("'{}' belongs to no material", as_utf8(key.text)),
                       "expected newmtl and a name first");
    if (key.text == "Kd")
      current_->kd = read_color();
    else if (key.text == "Ks")
      current_->ks = read_color();
    else if (key.text == "Ke")
      current_->ke = read_color();
    else if (key.text == "Ns")
      read_exponent();
    else if (key.text == "map_Kd")
      read_texture();
    else if (key.text == "illum")
      read_illum();
    else if (key.text == "d")
      read_dissolve(1, 1);
    else if (key.text == "Tr")
      read_dissolve(0, -1);
    else if (key.text != "Ka" && key.text != "Ni")
      pass_over(key);
  }

  void pass_over(const Words& key) {
    std::string name = as_utf8(key.text);
    if (passed_over_.empty()) passed_over_where_ = key.where;
    if (std::find(passed_over_.begin(), passed_over_.end(), name) == passed_over_.end())
      passed_over_.push_back(std::move(name));
  }

  void begin(const Words& key) {
    if (current_) finish(*current_);
    const Words name = take_rest();
    if (name.text.empty()) throw InputError(key.where, "this material has no name");
    current_.emplace();
    current_->name = as_utf8(name.text);
    current_->where = name.where;
  }

  StatedColor read_color() {
    const Words words = take_rest();
    for (const std::string_view other : {"xyz", "spectral"})
      if (words.text.starts_with(other))
        throw InputError(words.where, fmt::format("colours by '{}' are not read", other),
                         "write the linear r, g and b of Rec. 709");
    const Colorf color = parse_color(words.text, words.where);
    if (color.r < 0 || color.g < 0 || color.b < 0) throw InputError(words.where, "a colour is negative here");
    return {color, words.where};
  }

  void read_exponent() {
    const Words words = take_rest();
    current_->ns = {parse_real(words.text, words.where), words.where};
  }

  void read_illum() {
    const Words words = take_rest();
    current_->illum = parse_integer(words.text, words.where);
    if (current_->illum > 2)
      remarks_.add(words.where, "mirrors and glass of an illum above 2 are rendered as Kd and Ks alone",
                   take_it_out);
  }

  /// \param opaque the value that lets nothing through \param sign of what is more than that
  void read_dissolve(double opaque, double sign) {
    cursor_.skip_blanks();
    cursor_.accept("-halo");
    const Words words = take_rest();
    if (sign * parse_real(words.text, words.where) < sign * opaque)
      remarks_.add(words.where, "what lets light through is rendered opaque", take_it_out);
  }

  void read_texture() {
    for (;;) {
      const ObjCursor before = cursor_;
      const Words option = take_word();
      const auto* known = std::find_if(map_options.begin(), map_options.end(),
                                       [&](const MapOption& o) { return o.name == option.text; });
      if (known == map_options.end()) {
        cursor_ = before;
        break;
      }
      read_option(option, known->most_values);
    }
    current_->map_kd = take_rest();
    if (current_->map_kd->text.empty()) throw InputError(current_->map_kd->where, "map_Kd names no image");
  }

  void read_option(const Words& option, int most_values) {
    const std::string_view first = take_word().text;
    bool is_neutral = option.text.starts_with("-blend") || option.text == "-imfchan";
    if (option.text == "-clamp") {
      current_->is_clamped = first == "on";
      is_neutral = true;
    }
    is_neutral = is_neutral || first == "off";
    if (option.text == "-s") is_neutral = number_of(first) == 1;
    if (option.text == "-o" || option.text == "-t" || option.text == "-mm")
      is_neutral = number_of(first) == 0;
    const double neutral_next = option.text == "-s" || option.text == "-mm" ? 1 : 0;
    for (int k = 1; k < most_values; ++k) {
      const ObjCursor before = cursor_;
      const std::optional<double> next = number_of(take_word().text);
      if (!next) {
        cursor_ = before;
        break;
      }
      is_neutral = is_neutral && next == neutral_next;
    }
    if (!is_neutral)
      remarks_.add(option.where, "options of map_Kd are passed over",
                   "the image fills the unit square of the texture coordinates");
  }

  static std::optional<double> number_of(std::string_view text) {
    try {
      return parse_real(text, {});
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  void finish(const MaterialStatements& m) {
    const auto is_known = [&](const MtlMaterial& known) { return known.name == m.name; };
    if (std::any_of(library_.materials.begin(), library_.materials.end(), is_known)) {
      remarks_.add(m.where, "a material of this name has been before: the first counts", "");
      return;
    }
    const auto is_black = [](const std::optional<StatedColor>& c) {
      return !c || (c->value.r == 0 && c->value.g == 0 && c->value.b == 0);
    };
    MtlMaterial material{m.name, {}, {}};
    const bool has_lobe = !is_black(m.ks) && m.illum > 1;
    if (has_lobe && m.map_kd)
      remarks_.add(m.ks->where, "Ks is passed over: a material with a texture is diffuse", "");
    material.bsdf = m.map_kd ? textured(m) : has_lobe ? phong(m) : diffuse(m);
    if (!is_black(m.ke)) material.emitter = object(m, "emitter", "area", {color("radiance", *m.ke)});
    library_.materials.push_back(std::move(material));
  }

  static Object object(const MaterialStatements& m, std::string family, std::string type,
                       std::vector<Property> properties) {
    return {std::move(family), std::move(type), {}, m.where, m.where, std::move(properties), {}};
  }
  static Property color(std::string name, const StatedColor& stated) {
    return {std::move(name), "color", stated.value, stated.where, stated.where};
  }

  /// Who states other light and no Kd wants none; who states nothing gets the grey of a mesh without BSDF.
  static StatedColor kd_of(const MaterialStatements& m) {
    const float grey = m.ks || m.ke ? 0 : 0.5f;
    return m.kd.value_or(StatedColor{{grey, grey, grey}, m.where});
  }

  static Object diffuse(const MaterialStatements& m) {
    return object(m, "bsdf", "diffuse", {color("albedo", kd_of(m))});
  }

  Object phong(const MaterialStatements& m) {
    const StatedColor kd = kd_of(m);
    const Colorf sum = kd.value + m.ks->value;
    if (std::max({sum.r, sum.g, sum.b}) > 1)
      remarks_.add(m.ks->where,
                   "Kd and Ks add up to more than 1; both are scaled down to reflect no more than arrives",
                   "");
    std::vector<Property> properties{color("diffuseReflectance", kd), color("specularReflectance", *m.ks)};
    if (m.ns) {
      const auto& [exponent, where] = *m.ns;
      if (!(exponent >= 0 && exponent <= 1e6))
        throw InputError(where, fmt::format("Ns is {}; it must be from 0 to 1e6", exponent));
      properties.push_back({"exponent", "float", exponent, where, where});
    }
    return object(m, "bsdf", "phong", std::move(properties));
  }

  Object textured(const MaterialStatements& m) {
    const std::string stated = as_utf8(m.map_kd->text);
    existing_file(stated, m.map_kd->where, directory_ / name_.parent_path(), "an image", "the MTL file");
    if (m.kd && (m.kd->value.r != 1 || m.kd->value.g != 1 || m.kd->value.b != 1))
      remarks_.add(m.kd->where, "map_Kd takes the place of this Kd, and is not multiplied by it", "");
    const Location& where = m.map_kd->where;
    Object texture = object(m, "texture", "imagetexture",
                            {{"filename", "string", (name_.parent_path() / stated).string(), where, where}});
    texture.name = "albedo";
    texture.location = where;
    if (m.is_clamped) texture.properties.push_back({"wrap", "string", std::string("clamp"), where, where});
    Object bsdf = object(m, "bsdf", "diffuse", {});
    bsdf.children.push_back(std::move(texture));
    return bsdf;
  }

  std::filesystem::path directory_, name_;
  std::shared_ptr<const SourceFile> source_;
  ObjCursor cursor_;
  MtlLibrary library_;
  std::optional<MaterialStatements> current_;
  std::vector<std::string> passed_over_;  ///< Keys, each once.
  Location passed_over_where_;            ///< The first.
  Remarks remarks_;
};

}  // namespace

MtlLibrary read_mtl(const std::filesystem::path& directory, const std::filesystem::path& name) {
  constexpr std::string_view wanted = "a library of materials of an OBJ mesh";
  const std::shared_ptr<const SourceFile> source = read_whole_file(directory / name, wanted);
  const Location whole{std::make_shared<SourceFile>(SourceFile{source->path, {}})};
  if (const std::string_view format = format_of_content(source->text);
      !format.empty() && format != wanted && source->text.front() != '#')
    throw InputError(whole, fmt::format("this is {}, not {}", format, wanted));
  if (source->text.find('\0') != std::string::npos)
    throw InputError(whole, fmt::format("this is no text, and not {}", wanted));
  return MtlReader(directory, name, source).read();
}

}  // namespace etendue
