// SPDX-License-Identifier: GPL-3.0-or-later
// What a material is asked for, and whether its further bounces are worth their cost.
#ifndef MICROBOUNCE_ACCURACY_H
#define MICROBOUNCE_ACCURACY_H

#include "facet.h"
#include "smith.h"

struct Accuracy {
  int quality;      // 0 Single, 1 Fitted, 2 Walk, 3 Exact
  int max_bounces;  // at least 1
  int only;         // 0 all bounces, k > 0 bounce k alone
  float tolerance;  // energy below which further bounces are left out
  int walks;        // at each shading point, in Walk
  float kernel;     // half-width of smoothed exits, rad
};

// An upper bound of the energy that a white material sends on after its first bounce. Glass sends
// light to and from both sides, and the most where a flat surface would refract it along the
// horizon. Matte facets send light to the horizon whatever the view.
float further_energy_bound(Microsurface surface, Facet facet, vector wi)
{
  if (facet.kind == DIFFUSE)
    return (surface.beckmann ? 0.3 : 0.6) * max(surface.alpha_x, surface.alpha_y);
  float bound = missing_energy_bound(surface, wi);
  if (facet.kind == DIELECTRIC) {
    float sine2 = (1 - wi[2] * wi[2]) / (facet.ior * facet.ior);
    float z = 0.5 * sqrt(min(abs(1 - sine2), 1));
    bound = max(bound, missing_energy_bound(surface, vector(sqrt(1 - z * z), 0, z)));
  }
  return bound;
}

int has_further_bounces(Microsurface surface, Facet facet, vector wi, Accuracy accuracy)
{
  return accuracy.max_bounces > 1
         && further_energy_bound(surface, facet, wi) > accuracy.tolerance;
}

#endif
