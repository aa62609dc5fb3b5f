// SPDX-License-Identifier: GPL-3.0-or-later
// The first bounce of a diffuse surface: light goes wherever its facets face, times the chance to
// leave.
#ifndef MICROBOUNCE_DIFFUSE_H
#define MICROBOUNCE_DIFFUSE_H

#include "exits.h"
#include "walk.h"

// What is the same all around the normal is one lobe about it, the carrier, without any noise; the
// rest, which depends on the side that the surface is seen from, is left to smoothed exits.
#define DIFFUSE_FACETS 16
#define DIFFUSE_EXITS 8
#define KNOTS 8

closure color diffuse_first_bounce(Frame frame, Microsurface surface, Facet facet, float kernel,
                                   vector wi, output RandomStream stream)
{
  Incidence arrival = incidence(surface, wi);
  vector shift = next_numbers(stream);
  vector facets[DIFFUSE_FACETS];
  vector mean = vector(0);
  for (int i = 0; i < DIFFUSE_FACETS; ++i) {
    facets[i] = sample_visible_normal(surface, arrival, lattice_point(i, shift));
    mean += facets[i] / DIFFUSE_FACETS;
  }
  // The least light around the normal: no facet sees less than <m, o>, and the mean of these is
  // least on the side the mean facet faces away from. Of the two widths the rougher masks more.
  Microsurface rougher = surface;
  rougher.alpha_x = rougher.alpha_y = max(surface.alpha_x, surface.alpha_y);
  float slant = hypot(mean[0], mean[1]);
  color carrier[KNOTS];
  float knot[KNOTS];
  for (int k = 0; k < KNOTS; ++k) {
    float z = k / (KNOTS - 1.0);
    float sine = sqrt(1 - z * z);
    float least = max(mean[2] * z - slant * sine, 0);
    knot[k] = (least > 0) ? least * exit_probability(rougher, arrival, vector(sine, 0, z)) : 0;
    carrier[k] = color(knot[k]);
  }
  closure color lobes = facet.tint * diffuse_ramp(frame.z, carrier);
  vector turns = next_numbers(stream);
  for (int i = 0; i < DIFFUSE_EXITS; ++i) {
    vector u = lattice_point(i, turns);
    vector o = cosine_direction(facets[2 * i], u[0], u[1]);
    float leave = exit_probability(surface, arrival, o);
    if (leave <= 0)
      continue;
    float seen = 0;
    for (int j = 0; j < DIFFUSE_FACETS; ++j)
      seen += max(dot(facets[j], o), 0) / DIFFUSE_FACETS;
    int k = min(int(o[2] * (KNOTS - 1)), KNOTS - 2);
    float carried = mix(knot[k], knot[k + 1], o[2] * (KNOTS - 1) - k);
    float rest = leave - carried / seen;
    if (rest > 0)
      lobes = smooth_exit(frame, surface, facet, kernel, wi, o, 0,
                          facet.tint * (rest / DIFFUSE_EXITS))
              + lobes;
  }
  return lobes;
}

#endif
