// SPDX-License-Identifier: GPL-3.0-or-later
// Glass that is seen, with next to no noise. Cycles' own closure is the first bounce where it is
// near enough, elsewhere it is Single's. Further bounces are lobes on both sides, which also make
// good the energy of Cycles' closure.
#ifndef MICROBOUNCE_FITTED_DIELECTRIC_H
#define MICROBOUNCE_FITTED_DIELECTRIC_H

#include "../tables/dielectric_lobes.h"
#include "fitted.h"
#include "ramp.h"
#include "refraction.h"

// Alphas from which on Cycles' refraction is left for Single's, within a CROSSFADE: evaluated where
// no facet refracts to, it takes the density of facets that lean over, of which GGX has more.
#define WIDEST_WHOLE_GGX 0.3
#define WIDEST_WHOLE_BECKMANN 0.75
#define CROSSFADE 0.05

// Random facets for Single's refraction. Beside the further bounces, which have no noise, they make
// little more of it than all of Single's do.
#define FITTED_FACETS 5

// Least elevation (rad) of the mirrored view about a tilted normal.
#define LOWEST_MIRRORED 0.02

// Further bounces of so little energy, on either side, go the way of the first.
#define LEFT_TO_FIRST 0.005

// Tables begin and end with these indices.
int is_index_fitted(float ior)
{
  float index = max(ior, 1 / ior);
  return index >= LOWEST_INDEX && index <= HIGHEST_INDEX;
}

// The part of the first bounce that is Single's.
float share_of_single(Microsurface surface, int max_bounces)
{
  float widest = surface.beckmann ? WIDEST_WHOLE_BECKMANN : WIDEST_WHOLE_GGX;
  float share = clamp((surface.alpha_x - widest) / CROSSFADE, 0, 1);
  return (max_bounces == 1) ? 1 : share;
}

// The normal that leans towards the viewer by `angle`, as far as Cycles lets it be.
vector leaning_normal(Frame frame, vector wi, float angle)
{
  float theta = acos(clamp(wi[2], 0, 1));
  float reach = M_PI_2 - LOWEST_MIRRORED;
  float lean = clamp(angle, 0.5 * (theta - reach), 0.5 * (theta + reach));
  float sine = hypot(wi[0], wi[1]);
  vector side = (sine > 0) ? vector(wi[0], wi[1], 0) / sine : vector(1, 0, 0);
  return to_world(frame, sin(lean) * side + vector(0, 0, cos(lean)));
}

closure color fitted_dielectric(Frame frame, Microsurface surface, Facet facet, vector wi,
                                Accuracy accuracy)
{
  float single = share_of_single(surface, accuracy.max_bounces);
  closure color lobes = 0;
  color first = facet.tint;
  if (has_further_bounces(surface, facet, wi, accuracy)) {
    int inside = facet.ior < 1;
    float v[10], missing[2];
    dielectric_shape(surface.beckmann, inside, surface.alpha_x, wi[2], facet.ior, v);
    if (inside)
      dielectric_energy_inside(surface.beckmann, surface.alpha_x, wi[2], facet.ior, missing);
    else
      dielectric_energy_outside(surface.beckmann, surface.alpha_x, wi[2], facet.ior, missing);

    missing[0] *= missing[0];
    missing[1] *= missing[1];
    // Each bounce after the first leaves the same part for the next.
    color further = missing[1] * facet.tint * facet.tint
                    * successive_bounces(facet.tint, v[9], accuracy.max_bounces - 1);
    // What Cycles' closure has too much of the first bounce is taken from what goes through.
    color thinner = v[0] * v[0] * further;
    color back = inside ? further - thinner : thinner;
    color through = further - back - (1 - single) * (missing[1] - missing[0]) * facet.tint;
    back = max(back + min(through, color(0)), color(0));
    through = max(through, color(0));
    color least_back = min(back, color(LEFT_TO_FIRST));
    color least_through = min(through, color(LEFT_TO_FIRST));
    first += (least_back + least_through) / (1 - missing[0]);
    back -= (1 - single) * least_back;
    through -= (1 - single) * least_through;
    vector axis = leaning_normal(frame, wi, v[3]);
    color plateau[KNOTS];
    for (int k = 0; k < KNOTS; ++k)
      plateau[k] = plateau_knot(k);
    vector n = leaning_normal(frame, wi, v[7]);
    lobes = v[1] * v[2] * v[2] * through
                * microfacet("beckmann", axis, any_tangent(axis), v[4], v[4], STEEP_IOR, 1)
            + (1 - v[1]) * through * translucent(frame.z)
            + v[5] * v[6] * v[6] * back
                  * microfacet(distribution_name(surface), n, any_tangent(n), v[8], v[8], 1, 0)
            + (1 - v[5]) * back * diffuse_ramp(frame.z, plateau);
  }
  if (single > 0) {
    RandomStream stream = random_stream(P, I);
    int facets = (accuracy.max_bounces > 1) ? FITTED_FACETS : FACETS;
    lobes = single * (whole_reflection(frame, surface, facet, 1)
                      + first_refraction(grounded(frame), surface, facet, wi, facets,
                                          stream))
            + lobes;
  }
  if (single < 1)
    lobes = (1 - single) * first * dielectric_bsdf(frame.z, frame.x, color(1), color(1),
                                                   surface.alpha_x, surface.alpha_y, facet.ior,
                                                   distribution_name(surface))
            + lobes;
  return lobes;
}

#endif
