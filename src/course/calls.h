// What a student's code asks of the program during one sample, call by call: what a check reasons on.
#pragma once

#include "base/color.h"
#include "base/vec.h"
#include "geometry/ray.h"

#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

namespace etendue {

/// Sampler::next1D, next2D.
struct NumbersDrawn {
  int count;  ///< 1 or 2.
  Vec2f u;    ///< In [0, 1); of one number, x.
};

/// Scene::rayIntersect.
struct RayCast {
  Ray<float> ray;       ///< As it was given; the direction need not be unit.
  float t_near, t_far;  ///< In lengths of the direction.
  bool is_any_hit;      ///< Only whether there is a hit was asked.
  std::int32_t mesh;    ///< What is hit, by geometry; -1: nothing. Of any hit only whether it is -1 counts.
  float t;
};

/// Mesh::samplePosition.
struct PointSampled {
  std::int32_t mesh;  ///< By geometry.
  Vec2f u;            ///< As it was given.
  Vec3f position, ng;
};

/// Mesh::pdf.
struct DensityAsked {
  std::int32_t mesh;  ///< By geometry.
  float pdf_area;     ///< 1/m^2
};

/// Luminaire::eval, getColor.
struct EmissionAsked {
  std::int32_t mesh;     ///< By geometry.
  bool is_of_direction;  ///< Not of getColor, which is told nothing of what follows.
  Vec3f position, ng;    ///< Of the light, as they were given.
  Vec3f direction;       ///< Towards the light.
  Colorf radiance;       ///< W/(m^2 sr)
};

/// BSDF::eval, pdf, sample.
struct BsdfAsked {
  enum class What { value, density, sample } what;
  std::int32_t material;
  Vec3f wo_local, wi_local;  ///< To the viewer and to the light: BSDFQueryRecord::wi and ::wo.
  Colorf value;              ///< f (1/sr); of a sample its weight.
  float pdf;                 ///< 1/sr
  Vec2f u;                   ///< Of a sample: as it was given.
};

using Call = std::variant<NumbersDrawn, RayCast, PointSampled, DensityAsked, EmissionAsked, BsdfAsked>;

/// While it lives, what this thread's students' code asks is appended to `calls`, in order.
class CallRecording {
 public:
  explicit CallRecording(std::vector<Call>& calls) : outer_(std::exchange(current_, &calls)) {}
  ~CallRecording() { current_ = outer_; }
  CallRecording(const CallRecording&) = delete;
  CallRecording& operator=(const CallRecording&) = delete;

  static bool is_on() { return current_ != nullptr; }
  /// Where one is on.
  static void note(const Call& call) {
    if (current_) current_->push_back(call);
  }

 private:
  static thread_local std::vector<Call>* current_;
  std::vector<Call>* outer_;
};

}  // namespace etendue
