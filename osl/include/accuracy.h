// SPDX-License-Identifier: GPL-3.0-or-later
// What a material is asked for, and whether its further bounces are worth their cost.
#ifndef MICROBOUNCE_ACCURACY_H
#define MICROBOUNCE_ACCURACY_H

#include "material.h"
#include "smith.h"

// Choices of the input Quality.
#define QUALITY_SINGLE 0
#define QUALITY_FITTED 1
#define QUALITY_WALK 2
#define QUALITY_EXACT 3

struct Accuracy {
  int quality;
  int max_bounces;  // at least 1
  int only;         // 0 all bounces, k > 0 bounce k alone
  float tolerance;  // energy below which further bounces are left out
  int walks;        // at each shading point, in Walk
  float kernel;     // half-width of smoothed exits, rad
};

// An upper bound of the energy that a white material keeps after its first bounce. Glass scatters
// on both sides, most strongly at the angle where a flat surface refracts along the horizon. Matte
// facets send light to the horizon whatever the view.
float further_energy_bound(Microsurface surface, Material material, vector wi)
{
  if (material.kind == DIFFUSE)
    return (surface.beckmann ? 0.3 : 0.6) * max(surface.alpha_x, surface.alpha_y);
  float bound = missing_energy_bound(surface, wi);
  if (material.kind == DIELECTRIC) {
    float sine2 = (1 - wi[2] * wi[2]) / (material.ior * material.ior);
    float z = 0.5 * sqrt(min(abs(1 - sine2), 1));
    bound = max(bound, missing_energy_bound(surface, vector(sqrt(1 - z * z), 0, z)));
  }
  return bound;
}

int has_further_bounces(Microsurface surface, Material material, vector wi, Accuracy accuracy)
{
  return accuracy.max_bounces > 1
         && further_energy_bound(surface, material, wi) > accuracy.tolerance;
}

// Whether one walk stands for all bounces: always in Exact, and in Walk if `one_walk` asks for it.
int is_one_walk(Accuracy accuracy, int one_walk)
{
  return accuracy.quality == QUALITY_EXACT || (accuracy.quality > QUALITY_SINGLE && one_walk);
}

// Whether the first bounce has closures of its own.
int has_first_bounce(Accuracy accuracy, int one)
{
  return !one && accuracy.only < 2;
}

int has_walks(Microsurface surface, Material material, vector wi, Accuracy accuracy, int one)
{
  return one
         || (accuracy.quality > QUALITY_SINGLE && accuracy.only != 1
             && has_further_bounces(surface, material, wi, accuracy));
}

#endif
