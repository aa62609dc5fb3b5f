// SPDX-License-Identifier: GPL-3.0-or-later
// The first bounce of a diffuse surface: a cosine lobe about each facet, times the chance to
// leave.
#ifndef MICROBOUNCE_FIRST_DIFFUSE_H
#define MICROBOUNCE_FIRST_DIFFUSE_H

#include "exits.h"
#include "ramp.h"
#include "random.h"
#include "smith.h"
#include "visible.h"

#define DIFFUSE_FACETS 16
#define DIFFUSE_EXITS 8

// Width of these exits relative to those of further bounces. It can be small, as their weights
// are.
#define EXIT_WIDTH 0.75

// The carrier: two of Cycles' closures about the normal, which have no noise and most of the
// light. One is a ramp over the exit's cosine z, with z times the chance to leave; it is right for
// a view along the normal. The other is Oren and Nayar's lobe, which is brighter towards the
// viewer; its part grows with the mean slant of the visible facets. Smoothed exits have the rest.
#define NAYAR_PER_SLANT 2

// What is left of the carrier at the highest anisotropy.
#define PART_OF_ANISOTROPIC 0.5

// The carrier fades out below this cosine of the view. Cycles samples it by the exit's cosine,
// which misses the bright part of Oren and Nayar's lobe at grazing views.
#define GRAZING_VIEW 0.05

struct Carrier {
  float knots[KNOTS];  // of the ramp
  float nayar;         // factor of Oren and Nayar's lobe
};

Carrier diffuse_carrier(Microsurface surface, Incidence arrival, vector mean_facet, float energy)
{
  Carrier carrier;
  float part = min(NAYAR_PER_SLANT * hypot(mean_facet[0], mean_facet[1]), 1);
  Microsurface rougher = surface;
  rougher.alpha_x = rougher.alpha_y = max(surface.alpha_x, surface.alpha_y);
  rougher.isotropic = 1;
  for (int k = 0; k < KNOTS; ++k) {
    float z = k / (KNOTS - 1.0);
    vector o = vector(sqrt(1 - z * z), 0, z);
    carrier.knots[k] = (1 - part) * z * exit_probability(rougher, arrival, o);
  }
  carrier.nayar = part * energy;
  return carrier;
}

// pi times the carrier's BSDF times cosine.
float carried(Carrier carrier, vector wi, vector o)
{
  float x = o[2] * (KNOTS - 1);
  int k = min(int(x), KNOTS - 2);
  float t = wi[0] * o[0] + wi[1] * o[1];
  float lobe = o[2] + t * ((t > 0) ? o[2] / max(wi[2], o[2]) : o[2]);
  return mix(carrier.knots[k], carrier.knots[k + 1], x - k) + carrier.nayar * lobe;
}

closure color carrier_closures(Frame frame, Carrier carrier, color weight)
{
  color ramp[KNOTS];
  for (int k = 0; k < KNOTS; ++k)
    ramp[k] = weight * carrier.knots[k];
  return ramp_lobe(frame.z, ramp, 1) + nayar_lobe(frame.z, weight * carrier.nayar);
}

closure color first_diffuse(Frame frame, Microsurface surface, Material material, float kernel,
                            vector wi, output RandomStream stream)
{
  Incidence arrival = incidence(surface, wi);
  vector shift = next_numbers(stream), turns = next_numbers(stream);
  vector facets[DIFFUSE_FACETS];
  vector mean = vector(0);
  for (int i = 0; i < DIFFUSE_FACETS; ++i) {
    facets[i] = sample_visible_normal(surface, arrival, lattice_point(i, shift));
    mean += facets[i] / DIFFUSE_FACETS;
  }
  vector exits[DIFFUSE_EXITS];
  float leave[DIFFUSE_EXITS];
  float energy = 0;
  for (int i = 0; i < DIFFUSE_EXITS; ++i) {
    vector u = lattice_point(i, turns);
    exits[i] = cosine_direction(facets[2 * i], u[0], u[1]);
    leave[i] = exit_probability(surface, arrival, exits[i]);
    energy += leave[i] / DIFFUSE_EXITS;
  }
  // The carrier takes as much as no exit forbids.
  Carrier carrier = diffuse_carrier(surface, arrival, mean, energy);
  float share[DIFFUSE_EXITS];
  float part = 1;
  for (int i = 0; i < DIFFUSE_EXITS; ++i) {
    float seen = 0;
    for (int j = 0; j < DIFFUSE_FACETS; ++j)
      seen += max(dot(facets[j], exits[i]), 0) / DIFFUSE_FACETS;
    share[i] = (leave[i] > 0) ? carried(carrier, wi, exits[i]) / seen : 0;
    if (part * share[i] > leave[i])
      part = leave[i] / share[i];
  }
  part *= min(wi[2] / GRAZING_VIEW, 1);
  // The least of a few exits is random, and more so if the carrier is unlike the surface.
  if (surface.alpha_y < surface.alpha_x)
    part *= mix(PART_OF_ANISOTROPIC, 1, surface.alpha_y / surface.alpha_x);
  closure color lobes = carrier_closures(frame, carrier, part * material.tint);
  for (int i = 0; i < DIFFUSE_EXITS; ++i) {
    float rest = leave[i] - part * share[i];
    if (rest > 0)
      lobes = smooth_exit(frame, surface, material, EXIT_WIDTH * kernel, 1, wi, exits[i], 0,
                          material.tint * (rest / DIFFUSE_EXITS))
              + lobes;
  }
  return lobes;
}

#endif
