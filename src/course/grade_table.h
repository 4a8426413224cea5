// Many hand-ins in one table.
#pragma once

#include "course/rubric.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace etendue {

/// One line a hand-in, in their order: folder, group, outcome, points part by part, sum, what was found.
/// Parts that a person reads are left empty. \param results of check_submission
std::string grade_csv(const Rubric& rubric, const std::vector<nlohmann::json>& results);

/// The same as a page, with links to the reports. \param reports addresses, one a hand-in
std::string grade_page(const Rubric& rubric, const std::vector<nlohmann::json>& results,
                       const std::vector<std::string>& reports);

}  // namespace etendue
