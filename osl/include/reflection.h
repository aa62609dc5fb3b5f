// SPDX-License-Identifier: GPL-3.0-or-later
// The first bounce of what is reflected. Where Cycles has no closure for the whole of it, it has
// one for most of it, the carrier, which has no noise; the rest is left to some of the facets that
// the view sees, each of them a smooth lobe.
#ifndef MICROBOUNCE_REFLECTION_H
#define MICROBOUNCE_REFLECTION_H

#include "exits.h"
#include "random.h"
#include "smith.h"
#include "visible.h"

#define FACETS 10

// Half-width of a facet's lobe relative to the surface's.
#define FACET_LOBE 0.3

// The largest part of the carrier, at most `part`, that at none of the facets is brighter than what
// leaves.
float possible_part(float part, float leave[FACETS], float carried[FACETS], int facets)
{
  float possible = part;
  for (int i = 0; i < facets; ++i)
    if (possible * carried[i] > leave[i])
      possible = leave[i] / carried[i];
  return possible;
}

// Reflection by Cycles' own closures, which are height-correlated, times `part`.
closure color whole_reflection(Frame frame, Microsurface surface, Facet facet, color part)
{
  string ndf = distribution_name(surface);
  if (facet.kind == DIELECTRIC)
    return dielectric_bsdf(frame.z, frame.x, part * facet.tint, color(0), surface.alpha_x,
                           surface.alpha_y, facet.ior, ndf);
  if (facet.metal.physical)
    return part * conductor_bsdf(frame.z, frame.x, surface.alpha_x, surface.alpha_y,
                                 vector(facet.metal.first), vector(facet.metal.second), ndf);
  return part * microfacet_f82_tint(ndf, frame.z, frame.x, surface.alpha_x, surface.alpha_y,
                                    facet.metal.first, facet.metal.second);
}

// Reflection in the uncorrelated model: the correlated one is the carrier.
closure color uncorrelated_reflection(Frame frame, Microsurface surface, Facet facet, vector wi,
                                      output RandomStream stream)
{
  Microsurface correlated = surface;
  correlated.model = CORRELATED;
  Incidence arrival = incidence(surface, wi);
  vector shift = next_numbers(stream);
  vector exits[FACETS];
  float cosine[FACETS], leave[FACETS], carried[FACETS];
  for (int i = 0; i < FACETS; ++i) {
    vector m = sample_visible_normal(surface, arrival, lattice_point(i, shift));
    cosine[i] = clamp(dot(wi, m), 0, 1);
    exits[i] = 2 * cosine[i] * m - wi;
    leave[i] = exit_probability(surface, arrival, exits[i]);
    carried[i] = exit_probability(correlated, arrival, exits[i]);
  }
  float part = possible_part(1, leave, carried, FACETS);
  closure color lobes = whole_reflection(frame, surface, facet, part);
  for (int i = 0; i < FACETS; ++i) {
    float rest = leave[i] - part * carried[i];
    if (facet.kind == DIELECTRIC)
      rest *= dielectric_fresnel(facet.ior, cosine[i]);
    if (rest > 0)
      lobes = smooth_reflection(frame, wi, exits[i], FACET_LOBE * surface.alpha_x,
                                FACET_LOBE * surface.alpha_y,
                                facet_weight(facet, cosine[i]) * (rest / FACETS))
              + lobes;
  }
  return lobes;
}

// Reflection in any model.
closure color first_reflection(Frame frame, Microsurface surface, Facet facet, vector wi,
                               output RandomStream stream)
{
  closure color lobes = 0;
  if (surface.model == UNCORRELATED)
    lobes = uncorrelated_reflection(frame, surface, facet, wi, stream);
  else
    lobes = whole_reflection(frame, surface, facet, 1);
  return lobes;
}

#endif
