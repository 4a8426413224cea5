// The report of a check as one HTML file.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace etendue {

/// \param result of check_submission
/// \param folder where the check has left its pictures; those that are missing are left out
std::string check_page(const nlohmann::json& result, const std::filesystem::path& folder);

}  // namespace etendue
