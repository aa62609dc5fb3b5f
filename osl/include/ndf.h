// SPDX-License-Identifier: GPL-3.0-or-later
// The normal distribution: GGX or Beckmann, isotropic or anisotropic.
#ifndef MICROBOUNCE_NDF_H
#define MICROBOUNCE_NDF_H

struct Microsurface {
  float alpha_x;
  float alpha_y;
  int beckmann;  // 0 GGX, 1 Beckmann
};

// The direction as a surface with alpha 1 would see it (not normalised).
vector stretch(Microsurface surface, vector w)
{
  return vector(surface.alpha_x * w[0], surface.alpha_y * w[1], w[2]);
}

#endif
