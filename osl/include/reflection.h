// SPDX-License-Identifier: GPL-3.0-or-later
// The first bounce of reflected light. If Cycles has no closure for all of it, a carrier has most
// of it without noise. Smooth lobes about some of the visible facets have the rest.
#ifndef MICROBOUNCE_REFLECTION_H
#define MICROBOUNCE_REFLECTION_H

#include "exits.h"
#include "random.h"
#include "smith.h"
#include "visible.h"

#define FACETS 10

// Half-width of one facet's lobe over the surface's.
#define FACET_LOBE 0.3

// The largest part of the carrier, at most `part`, that sends no more than leaves at any facet.
float possible_part(float part, float leave[FACETS], float carried[FACETS], int facets)
{
  float possible = part;
  for (int i = 0; i < facets; ++i)
    if (possible * carried[i] > leave[i])
      possible = leave[i] / carried[i];
  return possible;
}

// Cycles' own reflection, which is height-correlated, times `part`.
closure color whole_reflection(Frame frame, Microsurface surface, Material material, color part)
{
  string ndf = distribution_name(surface);
  if (material.kind == DIELECTRIC)
    return dielectric_bsdf(frame.z, frame.x, part * material.tint, color(0), surface.alpha_x,
                           surface.alpha_y, material.ior, ndf);
  if (material.metal.physical)
    return part * conductor_bsdf(frame.z, frame.x, surface.alpha_x, surface.alpha_y,
                                 vector(material.metal.first), vector(material.metal.second), ndf);
  return part * microfacet_f82_tint(ndf, frame.z, frame.x, surface.alpha_x, surface.alpha_y,
                                    material.metal.first, material.metal.second);
}

// Reflection in the uncorrelated model, with the correlated one as the carrier.
closure color uncorrelated_reflection(Frame frame, Microsurface surface, Material material,
                                      vector wi, output RandomStream stream)
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
  closure color lobes = whole_reflection(frame, surface, material, part);
  for (int i = 0; i < FACETS; ++i) {
    float rest = leave[i] - part * carried[i];
    if (material.kind == DIELECTRIC)
      rest *= dielectric_fresnel(material.ior, cosine[i]);
    if (rest > 0)
      lobes = smooth_reflection(frame, wi, exits[i], FACET_LOBE * surface.alpha_x,
                                FACET_LOBE * surface.alpha_y,
                                scattering_factor(material, cosine[i]) * (rest / FACETS))
              + lobes;
  }
  return lobes;
}

// Reflection in any model.
closure color first_reflection(Frame frame, Microsurface surface, Material material, vector wi,
                               output RandomStream stream)
{
  closure color lobes = 0;
  if (surface.model == UNCORRELATED)
    lobes = uncorrelated_reflection(frame, surface, material, wi, stream);
  else
    lobes = whole_reflection(frame, surface, material, 1);
  return lobes;
}

#endif
