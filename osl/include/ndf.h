// SPDX-License-Identifier: GPL-3.0-or-later
// The rough surface: its normal distribution (NDF), and the model of how the heights of successive
// bounces depend on each other.
#ifndef MICROBOUNCE_NDF_H
#define MICROBOUNCE_NDF_H

// Choices of the inputs Distribution and Model.
#define GGX 0
#define BECKMANN 1

#define CORRELATED 0
#define UNCORRELATED 1
#define HEIGHT_TRACKED 2

struct Microsurface {
  float alpha_x;
  float alpha_y;
  int isotropic;  // alpha_x == alpha_y
  int beckmann;   // else GGX
  int model;
};

// Cycles' name for the distribution.
string distribution_name(Microsurface surface)
{
  return surface.beckmann ? "beckmann" : "ggx";
}

// The direction as a surface with alpha 1 would see it (not normalised).
vector stretch(Microsurface surface, vector w)
{
  return vector(surface.alpha_x * w[0], surface.alpha_y * w[1], w[2]);
}

#endif
