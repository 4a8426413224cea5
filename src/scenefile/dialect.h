// Which generation of the Nori family a file belongs to: its name, or the names that only one generation has.
#pragma once

#include "scenefile/scene_desc.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// "nori-2012", "nori-eth", "nori".
std::vector<std::string> dialect_names();
std::string_view dialect_name(Dialect dialect);
std::optional<Dialect> find_dialect(std::string_view name);
/// Throws InputError with the known names for an unknown one.
Dialect dialect_from_name(std::string_view name);

struct DialectGuess {
  Dialect dialect;
  std::string reason;  ///< Which element told it, with its line; or that none did.
  bool is_told = true;
};

/// Judges a whole file by the names in docs/scene_format.md ("The dialect"): the first generation's, then
/// those of the forks of ETH and Tuebingen; where there are none, `nori`, the generation in use. A file has
/// one dialect, however many scenes it holds.
DialectGuess recognize_dialect(const Object& root);

}  // namespace etendue
