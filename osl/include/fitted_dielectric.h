// SPDX-License-Identifier: GPL-3.0-or-later
// Glass that the camera sees, with almost no noise. The first bounce is Cycles' own closure where
// that is close enough, else Single's. Further bounces are lobes on both sides, which also correct
// the energy of Cycles' closure.
#ifndef MICROBOUNCE_FITTED_DIELECTRIC_H
#define MICROBOUNCE_FITTED_DIELECTRIC_H

#include "../tables/dielectric_lobes.h"
#include "fitted.h"
#include "ramp.h"
#include "refraction.h"

// Above this alpha, cross-fade from Cycles' refraction to Single's. In directions that no facet
// refracts to, Cycles uses the density of facets that lean past vertical; GGX has more of these.
#define WIDEST_WHOLE_GGX 0.3
#define WIDEST_WHOLE_BECKMANN 0.75
#define CROSSFADE 0.05

// Random facets for Single's refraction. They make little more noise than all of Single's, since
// the further bounces have none.
#define FITTED_FACETS 5

// The mirrored view about a tilted normal rises at least this far above the horizon (rad).
#define LOWEST_MIRRORED 0.02

// Bounces that carry less energy than this are folded into the first bounce's closure.
#define LEFT_TO_FIRST 0.005

// Whether the tables cover this index of refraction.
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

// The normal that leans towards the viewer by `angle`, as far as Cycles leaves it unbent.
vector leaning_normal(Frame frame, vector wi, float angle)
{
  float theta = acos(clamp(wi[2], 0, 1));
  float reach = M_PI_2 - LOWEST_MIRRORED;
  float lean = clamp(angle, 0.5 * (theta - reach), 0.5 * (theta + reach));
  float sine = hypot(wi[0], wi[1]);
  vector side = (sine > 0) ? vector(wi[0], wi[1], 0) / sine : vector(1, 0, 0);
  return to_world(frame, sin(lean) * side + vector(0, 0, cos(lean)));
}

closure color fitted_dielectric(Frame frame, Microsurface surface, Material material, vector wi,
                                Accuracy accuracy)
{
  float single = share_of_single(surface, accuracy.max_bounces);
  closure color lobes = 0;
  color first = material.tint;
  if (has_further_bounces(surface, material, wi, accuracy)) {
    int inside = material.ior < 1;
    float v[10], missing[2];
    dielectric_shape(surface.beckmann, inside, surface.alpha_x, wi[2], material.ior, v);
    if (inside)
      dielectric_energy_inside(surface.beckmann, surface.alpha_x, wi[2], material.ior, missing);
    else
      dielectric_energy_outside(surface.beckmann, surface.alpha_x, wi[2], material.ior, missing);

    float beyond_cycles = missing[GLASS_ROOT_BEYOND_CYCLES] * missing[GLASS_ROOT_BEYOND_CYCLES];
    float beyond_first = missing[GLASS_ROOT_BEYOND_FIRST] * missing[GLASS_ROOT_BEYOND_FIRST];
    float thinner_part = v[GLASS_ROOT_THINNER] * v[GLASS_ROOT_THINNER];
    // Each bounce after the first leaves the same part for the next.
    color further = beyond_first * material.tint * material.tint
                    * successive_bounces(material.tint, v[GLASS_REST], accuracy.max_bounces - 1);
    // Cycles' closure sends too much at the first bounce; what goes through makes up for that.
    color thinner = thinner_part * further;
    color back = inside ? further - thinner : thinner;
    color through = further - back - (1 - single) * (beyond_first - beyond_cycles) * material.tint;
    back = max(back + min(through, color(0)), color(0));
    through = max(through, color(0));
    color least_back = min(back, color(LEFT_TO_FIRST));
    color least_through = min(through, color(LEFT_TO_FIRST));
    first += (least_back + least_through) / (1 - beyond_cycles);
    back -= (1 - single) * least_back;
    through -= (1 - single) * least_through;
    vector axis = leaning_normal(frame, wi, v[GLASS_STEEP_TILT]);
    color plateau[KNOTS];
    for (int k = 0; k < KNOTS; ++k)
      plateau[k] = plateau_knot(k);
    vector n = leaning_normal(frame, wi, v[GLASS_MIRROR_TILT]);
    float steep = v[GLASS_STEEP_ROOT], width = v[GLASS_STEEP_WIDTH];
    float mirror = v[GLASS_MIRROR_ROOT], alpha = v[GLASS_MIRROR_ALPHA];
    lobes = v[GLASS_STEEP_PART] * steep * steep * through
                * microfacet("beckmann", axis, any_tangent(axis), width, width, STEEP_IOR, 1)
            + (1 - v[GLASS_STEEP_PART]) * through * translucent(frame.z)
            + v[GLASS_MIRROR_PART] * mirror * mirror * back
                  * microfacet(distribution_name(surface), n, any_tangent(n), alpha, alpha, 1, 0)
            + (1 - v[GLASS_MIRROR_PART]) * back * diffuse_ramp(frame.z, plateau);
  }
  if (single > 0) {
    RandomStream stream = random_stream(P, I);
    int facets = (accuracy.max_bounces > 1) ? FITTED_FACETS : FACETS;
    lobes = single * (whole_reflection(frame, surface, material, 1)
                      + first_refraction(grounded(frame), surface, material, wi, facets,
                                          stream))
            + lobes;
  }
  if (single < 1)
    lobes = (1 - single) * first * dielectric_bsdf(frame.z, frame.x, color(1), color(1),
                                                   surface.alpha_x, surface.alpha_y, material.ior,
                                                   distribution_name(surface))
            + lobes;
  return lobes;
}

#endif
