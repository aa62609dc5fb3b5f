// SPDX-License-Identifier: GPL-3.0-or-later
// All bounces of a material as a sum of Cycles' closures: the steps of the accuracy ladder.
#ifndef MICROBOUNCE_CLOSURES_H
#define MICROBOUNCE_CLOSURES_H

#include "diffuse.h"
#include "exits.h"
#include "first_bounce.h"
#include "walk.h"

// Candidates for the first vertex of each walk: more make it less noisy, and cost a vertex each.
#define CANDIDATES 4

// Widths of exits where a path is not seen by the camera at once, and goes on at random anyway:
// relative to the surface's, and of those that the camera sees.
#define NARROW_KERNEL 0.1

struct Accuracy {
  int quality;      // 0 Single, 1 Fitted, 2 Walk, 3 Exact
  int max_bounces;  // at least 1
  int only;         // 0 all bounces, k > 0 bounce k alone
  float tolerance;  // energy below which further bounces are left out
  int walks;        // at each shading point, in Walk
  float kernel;     // half-width of smoothed exits, rad
};

// The first bounce of a material.
closure color first_bounce(Frame frame, Microsurface surface, Facet facet, vector wi,
                           Accuracy accuracy, output RandomStream stream)
{
  if (facet.kind == DIFFUSE)
    return diffuse_first_bounce(frame, surface, facet, accuracy.kernel, wi, stream);
  closure color lobes = 0;
  if (surface.model == UNCORRELATED)
    lobes = uncorrelated_reflection(frame, surface, facet, wi, stream);
  else
    lobes = whole_reflection(frame, surface, facet, 1);
  if (facet.kind == DIELECTRIC)
    lobes = first_refraction(frame, surface, facet, wi, stream) + lobes;
  return lobes;
}

// All further bounces: `walks` walks, each of them one smooth lobe.
closure color further_bounces(Frame frame, Microsurface surface, Facet facet, vector wi,
                              Accuracy accuracy, output RandomStream stream)
{
  closure color lobes = 0;
  Incidence arrival = incidence(surface, wi);
  vector shift = next_numbers(stream);
  for (int i = 0; i < accuracy.walks; ++i) {
    float kept;
    Walker walker = walker_from(surface, wi, stream);
    Vertex first = sample_kept_vertex(surface, facet, arrival, walker, shift, i * CANDIDATES,
                                      CANDIDATES, stream, kept);
    if (kept <= 0)
      continue;
    walker.throughput = kept * facet_weight(facet, first.cosine);
    walker = stayed(surface, walker, first, stream);
    vector o = walk_to_exit(surface, facet, 1, accuracy.max_bounces, accuracy.only,
                            accuracy.tolerance, stream, walker);
    lobes = smooth_exit(frame, surface, facet, accuracy.kernel, KERNEL_PER_ALPHA, wi, o,
                        walker.below, walker.throughput / accuracy.walks)
            + lobes;
  }
  return lobes;
}

// Every bounce of one walk, as one closure: going exactly to its exit, or, in Walk, as a lobe much
// narrower than the surface's.
closure color one_walk(Frame frame, Microsurface surface, Facet facet, vector wi,
                       Accuracy accuracy, output RandomStream stream)
{
  Walker walker = walker_from(surface, wi, stream);
  vector o = walk_to_exit(surface, facet, 0, accuracy.max_bounces, accuracy.only,
                          accuracy.tolerance, stream, walker);
  if (accuracy.quality == 3)
    return walker.throughput * singular_exit(frame, facet, wi, o, walker.below);
  return smooth_exit(frame, surface, facet, NARROW_KERNEL * accuracy.kernel, NARROW_KERNEL, wi, o,
                     walker.below, walker.throughput);
}

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

// The material, by the steps of the accuracy ladder.
closure color all_closures(Frame frame, Microsurface surface, Facet facet, vector wi,
                           Accuracy accuracy, output RandomStream stream)
{
  closure color lobes = 0;
  Frame own = grounded(frame);
  // A path goes through glass many times, most of them after bounces that have spread it already.
  int one = facet.kind == DIELECTRIC && accuracy.quality > 0 && !raytype("camera");
  if (one || accuracy.quality == 3)
    return one_walk(own, surface, facet, wi, accuracy, stream);
  if (accuracy.only < 2)
    lobes = first_bounce(own, surface, facet, wi, accuracy, stream);
  if (accuracy.quality > 0 && accuracy.only != 1 && accuracy.max_bounces > 1
      && further_energy_bound(surface, facet, wi) > accuracy.tolerance)
    lobes = further_bounces(own, surface, facet, wi, accuracy, stream) + lobes;
  return lobes;
}

#endif
