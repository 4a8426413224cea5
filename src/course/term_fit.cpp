#include "course/term_fit.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace etendue {

namespace {

double channel_sum(const Colorf& c) { return double(c.r) + c.g + c.b; }

/// Samples that are compared: a receiver's, of finite value, with points on lights.
struct Compared {
  const SampleEvidence* sample;
  double scale;  ///< What rounding is held against: the ray's radiance.
};

bool is_alike(double a, double b, double scale) {
  constexpr double rounding = 3e-3, nothing = 1e-6;
  return std::abs(a - b) <= rounding * std::max(std::abs(a), std::abs(b)) + nothing * scale;
}
bool is_alike(const Colorf& a, const Colorf& b, double scale) {
  return is_alike(a.r, b.r, scale) && is_alike(a.g, b.g, scale) && is_alike(a.b, b.b, scale);
}

std::int64_t misses(std::span<const Compared> compared, const TermFit& fit) {
  return std::ranges::count_if(compared, [&](const Compared& one) {
    return !is_alike(one.sample->value, predicted(*one.sample, fit), one.scale);
  });
}

/// The factor that is missing most often; 1 where none is.
double missing_factor(std::span<const Compared> compared, const TermFit& fit) {
  std::vector<double> ratios;
  for (const Compared& one : compared) {
    const double found = channel_sum(one.sample->value), expected = channel_sum(predicted(*one.sample, fit));
    if (std::abs(found) > 1e-5 * one.scale && std::abs(expected) > 1e-5 * one.scale)
      ratios.push_back(found / expected);
  }
  if (ratios.size() < 20) return 1;
  const auto middle = ratios.begin() + std::ptrdiff_t(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return std::abs(*middle - 1) < 3e-3 ? 1 : *middle;
}

std::set<MistakeClass> classes_of(const TermFit& fit) {
  std::set<MistakeClass> classes;
  for (const TermMistake* one : fit.mistakes) classes.insert(one->mistake);
  if (fit.factor != 1) classes.insert(MistakeClass::constant_factor);
  return classes;
}

class Fitting {
 public:
  explicit Fitting(std::vector<Compared> compared) : compared_(std::move(compared)) {
    for (std::size_t i = 0; i < compared_.size(); i += 7) few_.push_back(compared_[i]);
  }

  void consider(std::vector<const TermMistake*> mistakes) {
    TermFit fit{std::move(mistakes)};
    consider_factor(fit);
    fit.factor = missing_factor(few_, fit);
    if (fit.factor != 1) consider_factor(fit);
  }

  std::vector<TermFit> cheapest() {
    std::ranges::stable_sort(fits_, {}, &TermFit::cost);
    std::vector<TermFit> best;
    std::set<std::set<MistakeClass>> seen;
    for (const TermFit& fit : fits_)
      if (seen.insert(classes_of(fit)).second) best.push_back(fit);
    return best;
  }

 private:
  /// Compares all only where a part of them does not look hopeless.
  void consider_factor(TermFit fit) {
    fit.misses = misses(few_, fit);
    if (fit.mistakes.size() > 1 && fit.misses > 2 * fewest_ + 10) return;
    fewest_ = std::min(fewest_, fit.misses);
    fit.misses = misses(compared_, fit);
    fits_.push_back(std::move(fit));
  }

  std::vector<Compared> compared_, few_;
  std::int64_t fewest_ = 1 << 30;
  std::vector<TermFit> fits_;
};

}  // namespace

bool TermFit::is_of_one_class() const { return classes_of(*this).size() == 1; }

double TermFit::cost() const {
  constexpr double of_a_miss = 5, of_a_mistake = 8, of_a_factor = 9;
  return of_a_miss * double(misses) + of_a_mistake * double(mistakes.size()) +
         (factor != 1 ? of_a_factor : 0);
}

Colorf predicted(const SampleEvidence& sample, const TermFit& fit) {
  Colorf sum{0, 0, 0};
  for (const LightPointFacts& point : sample.points) {
    LightTerms terms = right_terms(point);
    for (const TermMistake* mistake : fit.mistakes) mistake->change(terms, point);
    sum = sum + terms.value();
  }
  return sum * float(fit.factor);
}

TermFits fit_terms(const ProbeEvidence& evidence, std::span<const SampleEvidence> samples) {
  std::vector<Compared> compared;
  for (const SampleEvidence& sample : samples) {
    const RayEvidence& ray = evidence.rays[sample.ray];
    const double scale = ray.expected.r + ray.expected.g + ray.expected.b;
    if (!sample.points.empty() && !ray.is_light && std::isfinite(channel_sum(sample.value)))
      compared.push_back({&sample, scale});
  }
  TermFits fits;
  fits.samples = std::int64_t(compared.size());
  fits.wrong = misses(compared, {});
  Fitting fitting(std::move(compared));
  fitting.consider({});
  const std::vector<TermMistake>& all = term_mistakes();
  for (const TermMistake& one : all) fitting.consider({&one});
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j)
      if (all[i].mistake != all[j].mistake) {
        fitting.consider({&all[i], &all[j]});
        fitting.consider({&all[j], &all[i]});
      }
  fits.best = fitting.cheapest();
  return fits;
}

}  // namespace etendue
