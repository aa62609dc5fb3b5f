// SPDX-License-Identifier: GPL-3.0-or-later
// The first bounce of metal and glass.
#ifndef MICROBOUNCE_FIRST_BOUNCE_H
#define MICROBOUNCE_FIRST_BOUNCE_H

#include "exits.h"
#include "walk.h"

// Facets that the view sees, each of which is given a lobe of this width relative to the surface,
// where Cycles has no closure for the whole of a first bounce.
#define FACETS 8
#define FACET_LOBE 0.3

string distribution_name(Microsurface surface)
{
  return surface.beckmann ? "beckmann" : "ggx";
}

// Reflection: Cycles' own closures, which are height-correlated.
closure color whole_reflection(Frame frame, Microsurface surface, Facet facet)
{
  string ndf = distribution_name(surface);
  if (facet.kind == DIELECTRIC)
    return dielectric_bsdf(frame.z, frame.x, facet.tint, color(0), surface.alpha_x,
                           surface.alpha_y, facet.ior, ndf);
  if (facet.metal.physical)
    return conductor_bsdf(frame.z, frame.x, surface.alpha_x, surface.alpha_y,
                          vector(facet.metal.first), vector(facet.metal.second), ndf);
  return microfacet_f82_tint(ndf, frame.z, frame.x, surface.alpha_x, surface.alpha_y,
                             facet.metal.first, facet.metal.second);
}

// A lobe about the facet `m` that refracts to `down`, by Cycles' closure of that very facet unless
// Cycles would bend its normal.
closure color facet_transmission(Frame frame, vector wi, vector m, vector down, float ior,
                                 float alpha, color weight)
{
  if (is_left_alone(frame, wi, m))
    return weight * microfacet("beckmann", to_world(frame, m), to_world(frame, any_tangent(m)),
                               alpha, alpha, ior, 1);
  return smooth_transmission(frame, wi, down, alpha * abs(1 - 1 / ior), weight);
}

// The chance that a first vertex leaves after it has crossed to `o`, for a random `number`.
float crossing_probability(Microsurface surface, Incidence arrival, vector o, float number)
{
  if (surface.model == UNCORRELATED)
    return exit_probability(surface, arrival, o);
  return escape_chance(surface, o, height_from_below(height_met(arrival, number)));
}

// The first bounce off each of some facets: transmission, for which Cycles' closure has the masking
// of a reflection (too bright by a fourth where Lambda is 1/2); and reflection in the uncorrelated
// model.
closure color facet_by_facet(Frame frame, Microsurface surface, Facet facet, vector wi,
                             output RandomStream stream)
{
  closure color lobes = 0;
  Incidence arrival = incidence(surface, wi);
  vector shift = next_numbers(stream), heights = next_numbers(stream);
  float alpha_x = FACET_LOBE * surface.alpha_x, alpha_y = FACET_LOBE * surface.alpha_y;
  for (int i = 0; i < FACETS; ++i) {
    vector m = sample_visible_normal(surface, arrival, lattice_point(i, shift));
    float cosine = clamp(dot(wi, m), 0, 1);
    color weight = facet_weight(facet, cosine) / FACETS;
    float reflected = 1;
    if (facet.kind == DIELECTRIC) {
      reflected = dielectric_fresnel(facet.ior, cosine);
      vector o = refracted(wi, m, cosine, facet.ior);
      vector height = lattice_point(i, heights);
      float leave = crossing_probability(surface, arrival, o, height[0]);
      if (reflected < 1 && leave > 0)
        lobes = facet_transmission(frame, wi, m, -o, facet.ior, sqrt(alpha_x * alpha_y),
                                   weight * ((1 - reflected) * leave))
                + lobes;
    }
    if (surface.model == UNCORRELATED) {
      vector o = 2 * cosine * m - wi;
      float leave = exit_probability(surface, arrival, o);
      if (leave > 0)
        lobes = smooth_reflection(frame, wi, o, alpha_x, alpha_y, weight * (reflected * leave))
                + lobes;
    }
  }
  return lobes;
}

#endif
