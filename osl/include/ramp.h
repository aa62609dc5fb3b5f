// SPDX-License-Identifier: GPL-3.0-or-later
// Matte lobes: ramps over the cosine to an axis, and Oren and Nayar's.
#ifndef MICROBOUNCE_RAMP_H
#define MICROBOUNCE_RAMP_H

#include "stdcycles.h"

#define KNOTS 8

// Energy of a ramp about the normal: twice its mean over the cosine.
color ramp_energy(color knots[KNOTS])
{
  color sum = 0.5 * (knots[0] + knots[KNOTS - 1]);
  for (int k = 1; k < KNOTS - 1; ++k)
    sum += knots[k];
  return 2 / (KNOTS - 1.0) * sum;
}

// A lobe whose value times cosine is the ramp over the cosine to `axis`, over pi. Cycles picks
// lobes by the closure's weight, so the energy goes there and the ramp keeps the proportions.
// `emphasis` multiplies how often the lobe is picked; it helps if others are picked more often
// than they should.
closure color ramp_lobe(vector axis, color knots[KNOTS], float emphasis)
{
  color energy = ramp_energy(knots);
  color weight = emphasis * max(max(energy[0], energy[1]), energy[2]);
  float scale = 1 / weight[0];
  color proportions[KNOTS];
  for (int k = 0; k < KNOTS; ++k)
    proportions[k] = scale * knots[k];
  return weight * diffuse_ramp(axis, proportions);
}

// Oren and Nayar's lobe of roughness 1 as Cycles has it (Fujii's form), without interreflection,
// is (1 + t) / NAYAR_NORM times the cosine density z / pi. Here it goes without that norm.
#define NAYAR_NORM (1.5 - 2 / (3 * M_PI))

// Its energy for the view's cosine, without that norm: the integral of (1 + t) z / pi over the
// hemisphere. Only on the viewer's half is t divided by the larger of both cosines, so each half
// has its own integral.
float nayar_energy(float cosine)
{
  float c = clamp(cosine, 0, 1);
  float s = sqrt((1 - c) * (1 + c));
  float forward = 2 / 3.0 * (s * c * (1 + s + s * s) / (1 + s) - s);
  return 1 + (s * (acos(c) - s * c) + forward) / M_PI;
}

closure color nayar_lobe(vector n, color factor)
{
  // The closure's own interreflection grows with the square of its albedo.
  float albedo = 1e-4;
  return (NAYAR_NORM / albedo) * factor * oren_nayar_diffuse_bsdf(n, color(albedo), 1);
}

#endif
