// SPDX-License-Identifier: GPL-3.0-or-later
// Matte surfaces without noise: all bounces as a ramp about the normal, one about an axis tilted
// towards the viewer, and Oren and Nayar's lobe.
#ifndef MICROBOUNCE_FITTED_DIFFUSE_H
#define MICROBOUNCE_FITTED_DIFFUSE_H

#include "../tables/diffuse_lobes.h"
#include "fitted.h"
#include "frame.h"
#include "ramp.h"

// The closures' shares in bounces 1, 2 and all later ones, from the table's values on.
#define LOBES_OF_1 0
#define LOBES_OF_2 17
#define LOBES_OF_LATER 34

closure color fitted_diffuse(Frame frame, Microsurface surface, Facet facet, vector wi,
                             Accuracy accuracy)
{
  float v[44];
  diffuse_shape(surface.beckmann, surface.alpha_x, wi[2], v);
  color first = facet.tint, second = color(0), later = color(0);
  if (has_further_bounces(surface, facet, wi, accuracy)) {
    second = facet.tint * facet.tint;
    later = later_bounces(facet.tint, v[43], accuracy.max_bounces);
  }
  // White surfaces keep all light.
  float energy = (v[16] + v[33] + v[42]) * nayar_energy(wi[2]);
  color white[KNOTS], upright[KNOTS], tilted[KNOTS];
  for (int k = 0; k < KNOTS; ++k) {
    float up1 = v[k], up2 = v[LOBES_OF_2 + k], up3 = v[LOBES_OF_LATER + k];
    float tilted1 = v[KNOTS + k], tilted2 = v[LOBES_OF_2 + KNOTS + k];
    white[k] = color(up1 + up2 + up3);
    energy += (tilted1 + tilted2) * tilted_knot_energy(k);
    upright[k] = max(first * up1 + second * up2 + later * up3, color(0));
    tilted[k] = max(first * tilted1 + second * tilted2, color(0));
  }
  color whole = energy + ramp_energy(white);
  color nayar = first * v[16] + second * v[33] + later * v[42];
  float sine = hypot(wi[0], wi[1]);
  vector side = (sine > 0) ? vector(wi[0], wi[1], 0) / sine : vector(1, 0, 0);
  vector axis = sin(DIFFUSE_TILT) * side + vector(0, 0, cos(DIFFUSE_TILT));
  return (1 / whole[0])
         * (ramp_lobe(frame.z, upright, 1) + ramp_lobe(to_world(frame, axis), tilted, 1)
            + nayar_lobe(frame.z, max(nayar, color(0))));
}

#endif
