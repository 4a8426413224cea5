// Luminaires as later frameworks spell them.
#pragma once

#include <nori/luminaire.h>

NORI_NAMESPACE_BEGIN

/// A LuminaireQueryRecord whose direction is called wi; taken wherever that is asked for.
struct EmitterQueryRecord {
  Point3f ref;    ///< The place that is lit (m) ...
  Point3f p;      ///< ... and the point on the light (m).
  Normal3f n;     ///< Of the light at p, on the side that shines; unit.
  Vector3f wi;    ///< From ref to p, unit.
  float pdf = 0;  ///< With which p was chosen; of what it is a density, its user decides.
  Ray3f shadowRay;

  EmitterQueryRecord() = default;
  explicit EmitterQueryRecord(const Point3f& ref) : ref(ref) {}
  EmitterQueryRecord(const Point3f& ref, const Point3f& p, const Normal3f& n)
      : ref(ref), p(p), n(n), wi((p - ref).normalized()) {}

  operator LuminaireQueryRecord() const { return {nullptr, ref, p, n}; }
};

NORI_NAMESPACE_END
