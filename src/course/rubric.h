// How many points what a check has found is worth.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace etendue {

/// Points for one part of a hand-in. Points are lost for each property that is wrong, and half of that for
/// each of which nothing can be said; what is left is not negative.
struct RubricPart {
  struct Loss {
    std::string property;  ///< As a check names it.
    double points;         ///< Lost where it is wrong.
  };
  std::string title;  ///< "3.2.1 sampleLights".
  double points = 0;  ///< Where nothing is wrong.
  std::vector<Loss> losses{};
  bool is_written = false;  ///< Answers that a person reads: no points are given here.
};

using Rubric = std::vector<RubricPart>;

/// The handout's: 20 + 15 by the check, 2 + 3 + 5 + 5 left to the teacher.
Rubric default_rubric();

/// A JSON list of {"title", "points", "lose": {PROPERTY: POINTS}} or {"title", "points", "written": true}.
/// Throws InputError with the file and what is wrong with it.
Rubric read_rubric(const std::filesystem::path& file);

/// Points of a part by the result of check_submission; 0 where the code did not compile or was ended.
double points_of(const RubricPart& part, const nlohmann::json& result);

}  // namespace etendue
