// SPDX-License-Identifier: GPL-3.0-or-later
// What Fitted shares among all materials: closures from tables, without noise.
#ifndef MICROBOUNCE_FITTED_H
#define MICROBOUNCE_FITTED_H

#include "accuracy.h"

// What decides between Fitted and Walk. Tables cover the height-correlated model and all bounces
// together; for anisotropic surfaces there is only one of metal. Shaders continue in an `else`:
// OSL drops a branch not taken as a render starts, but nothing after an early return.
int is_fitted(Microsurface surface, Material material, Accuracy accuracy)
{
  return accuracy.quality == QUALITY_FITTED && accuracy.only == 0 && surface.model == CORRELATED
         && (material.kind == CONDUCTOR || surface.isotropic);
}

// Lower than the cosines of most facets that a bounce meets.
#define LOW_COSINE 0.2

// A metal's Fresnel factors at normal incidence and at LOW_COSINE.
struct FresnelRange {
  color straight;
  color low;
};

FresnelRange fresnel_range(Conductor metal)
{
  FresnelRange range;
  range.straight = conductor_fresnel(metal, 1);
  range.low = conductor_fresnel(metal, LOW_COSINE);
  return range;
}

// The mean of a metal's Fresnel factor over facets of many cosines. For Schlick's curve that mean
// is the value at `cosine`. The metal's own value there would be up to 0.01 too dark if its curve
// dips before it rises to 1.
color mean_fresnel(FresnelRange range, float cosine)
{
  float s = (1 - cosine) / (1 - LOW_COSINE), s2 = s * s;
  return mix(range.straight, range.low, min(s2 * s2 * s, 1));
}

// The light of `count` bounces over that of endless white ones. Each bounce has the factor `each`,
// apart from the first, and leaves the part `rest` for the next.
color successive_bounces(color each, float rest, int count)
{
  color kept = rest * each;
  color beyond = color(1), power = kept;  // kept^count
  for (int n = count; n > 0; n = n >> 1) {
    if (n & 1)
      beyond *= power;
    power *= power;
  }
  return ((1 - rest) / (1 - kept)) * (1 - beyond);
}

// The factor of bounces 3 to `max_bounces` on white light.
color later_bounces(color each, float rest, int max_bounces)
{
  return each * each * each * successive_bounces(each, rest, max_bounces - 2);
}

// Whether the camera sees the surface's own lobes, directly or in a sharp mirror.
int is_seen()
{
  return raytype("camera") || raytype("singular");
}

#endif
