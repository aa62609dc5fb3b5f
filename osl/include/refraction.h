// SPDX-License-Identifier: GPL-3.0-or-later
// The first bounce of what glass lets through, as a carrier and facets (reflection.h).
#ifndef MICROBOUNCE_REFRACTION_H
#define MICROBOUNCE_REFRACTION_H

#include "reflection.h"

// A facet's lobe is narrower where the facet stands nearly upright, since no facet leans over: at
// most so much of the facet's z, but no less than a part of FACET_LOBE.
#define LOBE_PER_Z 0.14
#define NARROWEST_LOBE 0.14

// Widest Beckmann closure that gives next to no light beyond all facets (see refraction_carrier):
// of alpha 1 that is 7 % of a back-lit sphere, as image L2.
#define WIDEST_CARRIER 0.75

// A product of alphas below 2e-10 is a mirror in Cycles.
#define SMOOTH_TO_CYCLES 1.5e-5

// Refraction is carried by Cycles' Beckmann closure, which is isotropic and has the masking of a
// reflection. Evaluated where no facet refracts to, Cycles' refraction takes the density of facets
// that lean over; Beckmann's have few of these.
Microsurface refraction_carrier(Microsurface surface)
{
  Microsurface carrier = surface;
  carrier.alpha_x = min(min(surface.alpha_x, surface.alpha_y), WIDEST_CARRIER);
  carrier.alpha_y = carrier.alpha_x;
  carrier.isotropic = 1;
  carrier.beckmann = 1;
  carrier.model = CORRELATED;
  return carrier;
}

// The carrier's NDF over the surface's at a micronormal that the surface has.
float ndf_ratio(Microsurface carrier, Microsurface surface, vector m)
{
  float x = m[0] / surface.alpha_x, y = m[1] / surface.alpha_y;
  float z2 = m[2] * m[2], per_z2 = 1 / z2;
  float exponent = (m[0] * m[0] + m[1] * m[1]) / (carrier.alpha_x * carrier.alpha_y);
  float width = surface.alpha_x * surface.alpha_y / (carrier.alpha_x * carrier.alpha_y);
  float slope2 = x * x + y * y;
  if (exponent > 80 * z2)
    return 0;
  if (surface.beckmann)
    return width * exp((slope2 - exponent) * per_z2);
  float ggx = 1 + slope2 * per_z2;
  return width * exp(-exponent * per_z2) * ggx * ggx;
}

// Its largest value: that of GGX is at the slope sqrt(2 k2 - 1), for the smaller of its alphas.
float largest_ndf_ratio(Microsurface carrier, Microsurface surface)
{
  float k2 = carrier.alpha_x / min(surface.alpha_x, surface.alpha_y);
  k2 *= k2;
  float width = surface.alpha_x * surface.alpha_y / (carrier.alpha_x * carrier.alpha_y);
  return (surface.beckmann || k2 < 0.5) ? width : width * 4 * k2 * k2 * exp(1 / k2 - 2);
}

// Refraction, for which Cycles' closures have the wrong masking: too bright by a fourth where
// Lambda is 1/2. `facets`: how many of them, at most FACETS.
closure color first_refraction(Frame frame, Microsurface surface, Facet facet, vector wi,
                               int facets, output RandomStream stream)
{
  Microsurface carrier = refraction_carrier(surface);
  Incidence arrival = incidence(surface, wi), carrier_arrival = incidence(carrier, wi);
  float scale = arrival.area / carrier_arrival.area;
  float widest = FACET_LOBE * min(surface.alpha_x, surface.alpha_y);
  vector shift = next_numbers(stream);
  vector exits[FACETS];
  float sent[FACETS], width[FACETS], leave[FACETS], carried[FACETS], most[FACETS];
  float largest = largest_ndf_ratio(carrier, surface);
  for (int i = 0; i < facets; ++i) {
    vector m = sample_visible_normal(surface, arrival, lattice_point(i, shift));
    float cosine = clamp(dot(wi, m), 0, 1);
    vector o = refracted(wi, m, cosine, facet.ior);
    exits[i] = o;
    sent[i] = 1 - dielectric_fresnel(facet.ior, cosine);
    leave[i] = leave_probability(surface, arrival, o, 1);
    float masked = scale * exit_probability(carrier, carrier_arrival, o);
    carried[i] = masked * ndf_ratio(carrier, surface, m);
    most[i] = masked * largest;
    width[i] = clamp(LOBE_PER_Z * m[2], NARROWEST_LOBE * widest, widest)
               * abs(dot(o, m) - cosine / facet.ior);
  }
  // Cycles does not sample a closure whose flat surface would refract nothing, and lets nothing be
  // masked where the index hardly changes or the surface is smooth.
  float part = dielectric_fresnel(facet.ior, wi[2]) < 0.5 && abs(facet.ior - 1) > 2e-4
               && carrier.alpha_x > SMOOTH_TO_CYCLES;
  part = possible_part(part, leave, most, facets);
  closure color lobes = dielectric_bsdf(frame.z, frame.x, color(0), part * facet.tint,
                                        carrier.alpha_x, carrier.alpha_y, facet.ior, "beckmann");
  for (int i = 0; i < facets; ++i) {
    float rest = sent[i] * (leave[i] - part * carried[i]);
    if (rest > 0)
      lobes = smooth_transmission(frame, wi, -exits[i], width[i], facet.tint * (rest / facets))
              + lobes;
  }
  return lobes;
}

#endif
