#include "course/light_mistakes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {

namespace {

using enum MistakeClass;

constexpr std::array texts{
    MistakeText{
        choice_probability_missing, "light-choice-probability-missing",
        "each light counts only as often as it is chosen: the probability of choosing it is not divided by",
        "3.2.1, steps 1 and 3: what is the probability that this very light is chosen?"},
    MistakeText{point_density_missing, "point-density-missing",
                "the density of the point on the light is missing: large lights are as bright as small ones",
                "3.2.1, step 3: Mesh::pdf"},
    MistakeText{density_multiplied, "density-multiplied",
                "a probability or a density is multiplied by where it should be divided by",
                "3.2, the estimator: where does p(x'') stand?"},
    MistakeText{foreign_random_numbers, "foreign-random-numbers",
                "random numbers come from elsewhere than from the sampler: no image can be had twice",
                "3.2.1: the numbers are those of _sample; 3.2.2: Sampler::next2D"},
    MistakeText{
        number_used_twice, "number-used-twice",
        "the number that chose the light also places the point on it: only a part of each light is sampled",
        "3.2.1, steps 1 and 2: is what is left of the number still uniform?"},
    MistakeText{light_never_chosen, "light-never-chosen", "some lights are never chosen",
                "3.2.1, step 1: which indices can come out, and how often each?"},
    MistakeText{visibility_term, "visibility",
                "shadows are wrong: what the shadow ray says is not whether the two places see each other",
                "3.2.1, step 3: the visibility term; where does the shadow ray start and end?"},
    MistakeText{receiver_cosine_of_other_angle, "receiver-cosine-of-other-angle",
                "the cosine at the receiver is that of another angle",
                "3.2.2 and 3.2: between which two directions is theta'?"},
    MistakeText{receiver_cosine_not_clamped, "receiver-cosine-not-clamped",
                "light comes from below the surface's horizon", "3.2.2: what if cos theta' is negative?"},
    MistakeText{light_cosine_sign, "light-cosine-sign",
                "the cosine at the light has the wrong sign, or none: lights shine backwards, or darkness",
                "3.2.1, the hint: lights that face away"},
    MistakeText{bsdf_in_world, "bsdf-in-world",
                "the BSDF is asked with directions of the world, not of the surface's frame",
                "3.2.2: BSDFQueryRecord wants local directions"},
    MistakeText{emission_missing, "emission-missing",
                "lights that the camera sees are not as bright as they are",
                "3.2.2: what if the ray meets a light?"},
    MistakeText{cosine_twice, "cosine-twice", "a cosine counts twice",
                "3.2.1, step 3 and 3.2.2: which method has which cosine?"},
    MistakeText{density_of_one_triangle, "density-of-one-triangle",
                "the density of the point is that of one triangle, not of the whole mesh",
                "3.2.1, step 3: Mesh::pdf"},
    MistakeText{
        measure_mixed_up, "measure-mixed-up",
        "densities per area and per solid angle are mixed up: the geometry term counts twice, or not at all",
        "3.2: over what does the integral run?"},
    MistakeText{interpolated_normal, "interpolated-normal",
                "the geometry term uses the interpolated normal of the light instead of that of its surface",
                "3.2.1, step 2: the normal that samplePosition gives"},
    MistakeText{distance_not_squared, "distance-not-squared", "the distance counts with a wrong power",
                "3.2: the geometry term"},
    MistakeText{constant_factor, "constant-factor", "all is too bright or too dark by one factor",
                "3.2, the estimator: is each factor there once?"},
    MistakeText{sample_shared_with_bsdf, "sample-shared-with-bsdf",
                "one random number serves two purposes: the sample of a light and one of the BSDF",
                "3.2.2: one new number for each decision"},
    MistakeText{invalid_values, "invalid-values", "some samples are not numbers, infinite or negative",
                "3.2.1: which division can be by zero?"},
    MistakeText{term_missing, "term-missing", "a term of the integrand is missing, or stands there twice",
                "3.2, the estimator: compare factor by factor"},
    MistakeText{nothing_returned, "nothing-returned", "nothing comes back: all is black",
                "3.2.1, step 4 and 3.2.2: what do the methods return?"}};

double clamped(double cosine) { return std::max(cosine, 0.0); }

/// In whichever direction it is wrong, a light that is seen from behind then shines as well.
void shine_on_both_sides(LightTerms& t, const LightPointFacts& f) { t.radiance = f.radiance; }

}  // namespace

const MistakeText& text_of(MistakeClass mistake) { return texts[std::size_t(mistake) - 1]; }

const std::vector<TermMistake>& term_mistakes() {
  using T = LightTerms;
  using F = LightPointFacts;
  static const std::vector<TermMistake> all{
      {choice_probability_missing, "1/pmf of the chosen light is missing",
       [](T& t, const F& f) { t.inverse_choice = 1 / f.points_per_sample; }},
      {point_density_missing, "1/Mesh::pdf() is missing", [](T& t, const F&) { t.area = 1; }},
      {density_multiplied, "multiplied by Mesh::pdf()", [](T& t, const F& f) { t.area = 1 / f.area; }},
      {density_multiplied, "multiplied by the probability of the light",
       [](T& t, const F& f) { t.inverse_choice = f.choice_probability / f.points_per_sample; }},
      {density_multiplied, "multiplied by Mesh::pdf() and by the probability of the light",
       [](T& t, const F& f) {
         t.area = 1 / f.area;
         t.inverse_choice = f.choice_probability / f.points_per_sample;
       }},
      {density_multiplied, "divided by Mesh::pdf() twice", [](T& t, const F& f) { t.area *= f.area; }},
      {density_multiplied, "divided by the probability of the light twice",
       [](T& t, const F& f) { t.inverse_choice /= f.choice_probability; }},
      {visibility_term, "nothing casts a shadow", [](T& t, const F&) { t.visibility = 1; }},
      {visibility_term, "lights cast no shadows",
       [](T& t, const F& f) { t.visibility = f.is_visible || f.is_hidden_by_light_only ? 1 : 0; }},
      {visibility_term,
       "it is as the shadow rays that were cast say, and they meet other things than what lies between",
       [](T& t, const F& f) { t.visibility = f.is_visible_to_student ? 1 : 0; }},
      {visibility_term, "light comes only where it is hidden",
       [](T& t, const F& f) { t.visibility = f.is_visible ? 0 : 1; }},
      {receiver_cosine_of_other_angle, "that of the camera ray",
       [](T& t, const F& f) { t.cos_receiver = f.cos_view; }},
      {receiver_cosine_of_other_angle, "that of the camera ray's other end",
       [](T& t, const F& f) { t.cos_receiver = -f.cos_view; }},
      {receiver_cosine_of_other_angle, "z of the direction in the world",
       [](T& t, const F& f) { t.cos_receiver = f.direction.z; }},
      {receiver_cosine_of_other_angle, "z of the direction in the world, where positive",
       [](T& t, const F& f) { t.cos_receiver = clamped(f.direction.z); }},
      {receiver_cosine_of_other_angle, "|z| of the direction in the world",
       [](T& t, const F& f) { t.cos_receiver = std::abs(f.direction.z); }},
      {receiver_cosine_of_other_angle, "with the geometric normal",
       [](T& t, const F& f) { t.cos_receiver = clamped(f.cos_receiver_geometric); }},
      {receiver_cosine_of_other_angle, "with the geometric normal, and the BSDF in its frame",
       [](T& t, const F& f) {
         t.cos_receiver = clamped(f.cos_receiver_geometric);
         t.bsdf = f.bsdf_geometric;
       }},
      {receiver_cosine_not_clamped, "|cos theta'|, and the BSDF of the mirrored direction",
       [](T& t, const F& f) {
         t.cos_receiver = std::abs(f.cos_receiver);
         t.bsdf = f.bsdf_mirrored;
       }},
      {receiver_cosine_not_clamped, "cos theta' as it is, and the BSDF of the mirrored direction",
       [](T& t, const F& f) {
         t.cos_receiver = f.cos_receiver;
         t.bsdf = f.bsdf_mirrored;
       }},
      {light_cosine_sign, "|cos theta''|: lights shine to both sides",
       [](T& t, const F& f) {
         shine_on_both_sides(t, f);
         t.cos_light = std::abs(f.cos_light);
       }},
      {light_cosine_sign, "-cos theta'': lights shine backwards",
       [](T& t, const F& f) {
         shine_on_both_sides(t, f);
         t.cos_light = clamped(-f.cos_light);
       }},
      {light_cosine_sign, "-cos theta'': negative before the light",
       [](T& t, const F& f) {
         shine_on_both_sides(t, f);
         t.cos_light = -f.cos_light;
       }},
      {light_cosine_sign, "cos theta'' not clamped: negative behind the light",
       [](T& t, const F& f) {
         shine_on_both_sides(t, f);
         t.cos_light = f.cos_light;
       }},
      {light_cosine_sign, "-cos theta'' with the light's own front side",
       [](T& t, const F& f) { t.cos_light = -clamped(f.cos_light); }},
      {light_cosine_sign, "all is black before the light",
       [](T& t, const F& f) { t.cos_light = f.cos_light > 0 ? 0 : t.cos_light; }},
      {bsdf_in_world, "both directions", [](T& t, const F& f) { t.bsdf = f.bsdf_of_world; }},
      {bsdf_in_world, "both directions, and the cosine with them",
       [](T& t, const F& f) {
         t.bsdf = f.bsdf_of_world;
         t.cos_receiver = f.direction.z;
       }},
      {cosine_twice, "cos theta' twice", [](T& t, const F&) { t.cos_receiver *= t.cos_receiver; }},
      {cosine_twice, "cos theta'' twice", [](T& t, const F&) { t.cos_light *= t.cos_light; }},
      {density_of_one_triangle, "that of the first triangle",
       [](T& t, const F& f) { t.area = f.first_triangle_area; }},
      {density_of_one_triangle, "multiplied by the number of triangles",
       [](T& t, const F& f) { t.area /= f.triangle_count; }},
      {density_of_one_triangle, "divided by the number of triangles",
       [](T& t, const F& f) { t.area *= f.triangle_count; }},
      {measure_mixed_up, "a solid-angle density where one per area belongs: cos theta''/d^2 twice",
       [](T& t, const F& f) { t.factor *= clamped(f.cos_light) / (f.distance * f.distance); }},
      {measure_mixed_up, "cos theta''/d^2 is divided out",
       [](T& t, const F& f) {
         t.cos_light = f.cos_light > 0 ? 1 : 0;
         t.inverse_distance_sq = 1;
       }},
      {measure_mixed_up, "cos theta''/d^2 is inverted",
       [](T& t, const F& f) {
         t.cos_light = f.cos_light > 0 ? 1 / f.cos_light : 0;
         t.inverse_distance_sq = f.distance * f.distance;
       }},
      {interpolated_normal, "at the light",
       [](T& t, const F& f) { t.cos_light = clamped(f.cos_light_shading); }},
      {interpolated_normal, "at the light, on both sides",
       [](T& t, const F& f) {
         shine_on_both_sides(t, f);
         t.cos_light = clamped(f.cos_light_shading);
       }},
      {distance_not_squared, "1/d instead of 1/d^2",
       [](T& t, const F& f) { t.inverse_distance_sq *= f.distance; }},
      {distance_not_squared, "1/d^4 instead of 1/d^2",
       [](T& t, const F& f) { t.inverse_distance_sq /= f.distance * f.distance; }},
      {distance_not_squared, "1/d^2 is missing", [](T& t, const F&) { t.inverse_distance_sq = 1; }},
      {distance_not_squared, "1/d^3 instead of 1/d^2",
       [](T& t, const F& f) { t.inverse_distance_sq /= f.distance; }},
      {term_missing, "cos theta' is missing",
       [](T& t, const F& f) { t.cos_receiver = f.cos_receiver > 0 ? 1 : 0; }},
      {term_missing, "cos theta'' is missing",
       [](T& t, const F& f) { t.cos_light = f.cos_light > 0 ? 1 : 0; }},
      {term_missing, "the BSDF is missing",
       [](T& t, const F& f) {
         t.bsdf = f.cos_receiver > 0 ? Colorf{1, 1, 1} : Colorf{0, 0, 0};
       }},
      {term_missing, "the BSDF stands there twice", [](T& t, const F& f) { t.bsdf = f.bsdf * f.bsdf; }},
      {term_missing, "the light's radiance is missing",
       [](T& t, const F& f) {
         t.radiance = f.cos_light > 0 ? Colorf{1, 1, 1} : Colorf{0, 0, 0};
       }},
  };
  return all;
}

}  // namespace etendue
