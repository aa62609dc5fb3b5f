// SPDX-License-Identifier: GPL-3.0-or-later
// What the Fitted steps of all materials share: closures from tables, without noise.
#ifndef MICROBOUNCE_FITTED_H
#define MICROBOUNCE_FITTED_H

#include "accuracy.h"

// Tables are of height-correlated surfaces, for all bounces together, and of metal alone where the
// surface is anisotropic. Shaders go on in an else: as a render starts OSL drops the branch that is
// not taken, but nothing that follows an early return.
int is_fitted(Microsurface surface, Facet facet, Accuracy accuracy)
{
  return accuracy.quality == 1 && accuracy.only == 0 && surface.model == CORRELATED
         && (facet.kind == CONDUCTOR || surface.isotropic);
}

// A cosine well below those of most facets that a bounce meets.
#define LOW_COSINE 0.2

// A metal's Fresnel factors for facets seen straight and at a low cosine.
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

// The mean of a metal's Fresnel factor over facets of many cosines, where Schlick's is that at
// `cosine`. The factor at `cosine` itself would be up to 0.01 too dark for metals that reflect less
// before they reflect all.
color mean_fresnel(FresnelRange range, float cosine)
{
  float s = (1 - cosine) / (1 - LOW_COSINE), s2 = s * s;
  return mix(range.straight, range.low, min(s2 * s2 * s, 1));
}

// The light of `count` bounces of which each has the factor `each` and leaves the part `rest` for
// the next, over what endless white ones send, without the factor of the first.
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

// The factor on white light of bounces 3 to `max_bounces`.
color later_bounces(color each, float rest, int max_bounces)
{
  return each * each * each * successive_bounces(each, rest, max_bounces - 2);
}

// Whether a surface shows its own lobes: to the camera, also by a sharp mirror.
int is_seen()
{
  return raytype("camera") || raytype("singular");
}

#endif
