// SPDX-License-Identifier: GPL-3.0-or-later
// The first bounce of light that glass transmits, as a carrier and facets (reflection.h).
#ifndef MICROBOUNCE_REFRACTION_H
#define MICROBOUNCE_REFRACTION_H

#include "reflection.h"

// Facets never lean past vertical, so a lobe narrows as its facet nears vertical: at most
// LOBE_PER_Z * m.z, at least NARROWEST_LOBE * FACET_LOBE.
#define LOBE_PER_Z 0.14
#define NARROWEST_LOBE 0.14

// Widest Beckmann closure that sends almost no light where no facet refracts (refraction_carrier).
// At alpha 1 that light is 7 % of a back-lit sphere, as image L2.
#define WIDEST_CARRIER 0.75

// Cycles takes a product of alphas below 2e-10 for a mirror.
#define SMOOTH_TO_CYCLES 1.5e-5

// The surface of the carrier: Cycles' isotropic Beckmann refraction, which has a reflection's
// masking. In directions that no facet refracts to, Cycles uses the density of facets that lean
// past vertical; Beckmann has few of these.
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

// The carrier's NDF over the surface's, at one of the surface's micronormals.
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

// The largest value of ndf_ratio. For GGX it is at the slope sqrt(2 k2 - 1), with the smaller
// alpha.
float largest_ndf_ratio(Microsurface carrier, Microsurface surface)
{
  float k2 = carrier.alpha_x / min(surface.alpha_x, surface.alpha_y);
  k2 *= k2;
  float width = surface.alpha_x * surface.alpha_y / (carrier.alpha_x * carrier.alpha_y);
  return (surface.beckmann || k2 < 0.5) ? width : width * 4 * k2 * k2 * exp(1 / k2 - 2);
}

// Refraction with the right masking. Cycles' closures are a fourth too bright where Lambda is 1/2.
// `facets` is how many facets to take, at most FACETS.
closure color first_refraction(Frame frame, Microsurface surface, Material material, vector wi,
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
    vector o = refracted(wi, m, cosine, material.ior);
    exits[i] = o;
    sent[i] = 1 - dielectric_fresnel(material.ior, cosine);
    leave[i] = leave_probability(surface, arrival, o, 1);
    float masked = scale * exit_probability(carrier, carrier_arrival, o);
    carried[i] = masked * ndf_ratio(carrier, surface, m);
    most[i] = masked * largest;
    width[i] = clamp(LOBE_PER_Z * m[2], NARROWEST_LOBE * widest, widest)
               * abs(dot(o, m) - cosine / material.ior);
  }
  // Cycles does not sample a closure if a flat surface would refract nothing, and masks nothing if
  // the index hardly changes or the surface is smooth.
  float part = dielectric_fresnel(material.ior, wi[2]) < 0.5 && abs(material.ior - 1) > 2e-4
               && carrier.alpha_x > SMOOTH_TO_CYCLES;
  part = possible_part(part, leave, most, facets);
  closure color lobes = dielectric_bsdf(frame.z, frame.x, color(0), part * material.tint,
                                        carrier.alpha_x, carrier.alpha_y, material.ior, "beckmann");
  for (int i = 0; i < facets; ++i) {
    float rest = sent[i] * (leave[i] - part * carried[i]);
    if (rest > 0)
      lobes = smooth_transmission(frame, wi, -exits[i], width[i], material.tint * (rest / facets))
              + lobes;
  }
  return lobes;
}

#endif
