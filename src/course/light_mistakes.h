// Mistakes that are made in the exercise, each as what it does to the terms of a light sample.
#pragma once

#include "course/light_terms.h"

#include <string_view>
#include <vector>

namespace etendue {

/// Classes of mistakes; several ways to make one share its class.
enum class MistakeClass {
  choice_probability_missing = 1,
  point_density_missing,
  density_multiplied,
  foreign_random_numbers,
  number_used_twice,
  light_never_chosen,
  visibility_term,
  receiver_cosine_of_other_angle,
  receiver_cosine_not_clamped,
  light_cosine_sign,
  bsdf_in_world,
  emission_missing,
  cosine_twice,
  density_of_one_triangle,
  measure_mixed_up,
  interpolated_normal,
  distance_not_squared,
  constant_factor,
  sample_shared_with_bsdf,
  invalid_values,
  term_missing,     ///< A term of the integrand is left out.
  nothing_returned  ///< All is black.
};

struct MistakeText {
  MistakeClass mistake;
  std::string_view name;  ///< "light-choice-probability-missing": of JSON files.
  std::string_view what;  ///< In words, for the student.
  std::string_view read;  ///< Where in the handout.
};
const MistakeText& text_of(MistakeClass mistake);

/// One way to make a mistake that changes single terms.
struct TermMistake {
  MistakeClass mistake;
  std::string_view how;  ///< In a few words: "divided by the area instead of multiplied".
  void (*change)(LightTerms&, const LightPointFacts&);
};
const std::vector<TermMistake>& term_mistakes();

}  // namespace etendue
