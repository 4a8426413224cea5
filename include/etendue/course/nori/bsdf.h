// What a surface does to light: how much of what arrives from one direction leaves in another.
#pragma once

#include <nori/color.h>
#include <nori/frame.h>
#include <nori/object.h>

NORI_NAMESPACE_BEGIN

/// Of what a density is one: of nothing said, per solid angle, or of a single direction, as of a mirror.
enum EMeasure { EUnknownMeasure, ESolidAngle, EDiscrete };

/// Two directions at a surface, and what a sample says of itself. Directions are *local* (see Frame), unit,
/// and point away from the surface.
struct BSDFQueryRecord {
  Vector3f wi;                         ///< To where the light is seen from: the camera.
  Vector3f wo;                         ///< To where the light comes from.
  float eta = 1;                       ///< Out of `sample`: refractive index behind over that before.
  EMeasure measure = EUnknownMeasure;  ///< A discrete one asks for mirror-like parts alone: 0 in `eval`.
  Point2f uv;                          ///< Where textures are looked up; Intersection::uv.
  Point3f p;                           ///< Nothing depends on it.

  explicit BSDFQueryRecord(const Vector3f& wi) : wi(wi) {}
  BSDFQueryRecord(const Vector3f& wi, const Vector3f& wo, EMeasure measure = ESolidAngle)
      : wi(wi), wo(wo), measure(measure) {}
};

class NORI_SHARED BSDF : public NoriObject {
 public:
  /// f(wi, wo) in 1/sr, *without* the cosine at the surface; 0 where nothing is scattered, as from behind.
  virtual Color3f eval(const BSDFQueryRecord& bRec) const = 0;
  /// The density (1/sr, per solid angle of wo) with which `sample` gives bRec.wo.
  virtual float pdf(const BSDFQueryRecord& bRec) const = 0;
  /// Fills in wo, eta and measure. Returns f |cos theta_o| / pdf; 0 where there is no sample.
  /// \param sample uniform in the unit square
  virtual Color3f sample(BSDFQueryRecord& bRec, const Point2f& sample) const = 0;
  virtual bool isDiffuse() const = 0;
};

NORI_NAMESPACE_END
