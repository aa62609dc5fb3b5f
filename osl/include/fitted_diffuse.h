// SPDX-License-Identifier: GPL-3.0-or-later
// Matte surfaces without noise. All bounces are three closures: a ramp about the normal, a ramp
// about an axis tilted towards the viewer, and Oren and Nayar's lobe.
#ifndef MICROBOUNCE_FITTED_DIFFUSE_H
#define MICROBOUNCE_FITTED_DIFFUSE_H

#include "../tables/diffuse_lobes.h"
#include "fitted.h"
#include "frame.h"
#include "ramp.h"

closure color fitted_diffuse(Frame frame, Microsurface surface, Material material, vector wi,
                             Accuracy accuracy)
{
  float v[44];
  diffuse_shape(surface.beckmann, surface.alpha_x, wi[2], v);
  color first = material.tint, second = color(0), later = color(0);
  if (has_further_bounces(surface, material, wi, accuracy)) {
    second = material.tint * material.tint;
    later = later_bounces(material.tint, v[MATTE_REST], accuracy.max_bounces);
  }
  // Normalised so that a white surface keeps all light.
  float energy = (v[MATTE_NAYAR_1] + v[MATTE_NAYAR_2] + v[MATTE_NAYAR_LATER]) * nayar_energy(wi[2]);
  color white[KNOTS], upright[KNOTS], tilted[KNOTS];
  for (int k = 0; k < KNOTS; ++k) {
    float up1 = v[MATTE_UPRIGHT_1 + k], up2 = v[MATTE_UPRIGHT_2 + k];
    float up3 = v[MATTE_UPRIGHT_LATER + k];
    float tilted1 = v[MATTE_TILTED_1 + k], tilted2 = v[MATTE_TILTED_2 + k];
    white[k] = color(up1 + up2 + up3);
    energy += (tilted1 + tilted2) * tilted_knot_energy(k);
    upright[k] = max(first * up1 + second * up2 + later * up3, color(0));
    tilted[k] = max(first * tilted1 + second * tilted2, color(0));
  }
  color whole = energy + ramp_energy(white);
  color nayar = first * v[MATTE_NAYAR_1] + second * v[MATTE_NAYAR_2]
                + later * v[MATTE_NAYAR_LATER];
  float sine = hypot(wi[0], wi[1]);
  vector side = (sine > 0) ? vector(wi[0], wi[1], 0) / sine : vector(1, 0, 0);
  vector axis = sin(DIFFUSE_TILT) * side + vector(0, 0, cos(DIFFUSE_TILT));
  return (1 / whole[0])
         * (ramp_lobe(frame.z, upright, 1) + ramp_lobe(to_world(frame, axis), tilted, 1)
            + nayar_lobe(frame.z, max(nayar, color(0))));
}

#endif
