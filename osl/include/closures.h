// SPDX-License-Identifier: GPL-3.0-or-later
// All bounces of a material as a sum of Cycles' closures: the steps of the accuracy ladder.
//
// Before this header a shader includes one of first_conductor.h, first_dielectric.h and
// first_diffuse.h, which all have
//   closure color first_bounce(Frame frame, Microsurface surface, Facet facet, float kernel,
//                              vector wi, output RandomStream stream)
// so that it holds the code of its own material alone: as a render starts OSL reads all code
// before it drops what is not needed.
#ifndef MICROBOUNCE_CLOSURES_H
#define MICROBOUNCE_CLOSURES_H

#include "accuracy.h"
#include "exits.h"
#include "walk.h"

// Candidates for the first vertex of each walk: more make it less noisy, and cost a vertex each.
#define CANDIDATES 4

// Width of the exit of one walk alone, over the surface's and over `kernel`: such paths go on at
// random anyway.
#define NARROW_KERNEL 0.1

// Walks, each of them one closure: `accuracy.walks` of the further bounces, as smooth lobes; or
// `one` of every bounce, which in Exact goes exactly to its exit.
closure color all_walks(Frame frame, Microsurface surface, Facet facet, vector wi,
                        Accuracy accuracy, int one, output RandomStream stream)
{
  closure color lobes = 0;
  Incidence arrival = incidence(surface, wi);
  int walks = one ? 1 : accuracy.walks;
  float kernel = one ? NARROW_KERNEL * accuracy.kernel : accuracy.kernel;
  float relative = one ? NARROW_KERNEL : KERNEL_PER_ALPHA;
  vector shift = one ? vector(0) : next_numbers(stream);
  for (int i = 0; i < walks; ++i) {
    Walker walker = walker_from(surface, arrival, stream);
    int bounces = 0;
    if (!one) {
      float kept;
      Vertex first = sample_kept_vertex(surface, facet, arrival, walker, shift, i * CANDIDATES,
                                        CANDIDATES, stream, kept);
      if (kept <= 0)
        continue;
      walker.throughput = kept * facet_weight(facet, first.cosine);
      walker = stayed(surface, walker, first, stream);
      bounces = 1;
    }
    vector o = walk_to_exit(surface, facet, bounces, accuracy.max_bounces, accuracy.only,
                            accuracy.tolerance, stream, walker);
    color weight = walker.throughput / walks;
    if (accuracy.quality == 3)
      lobes = weight * singular_exit(frame, facet, wi, o, walker.below) + lobes;
    else
      lobes = smooth_exit(frame, surface, facet, kernel, relative, wi, o, walker.below, weight)
              + lobes;
  }
  return lobes;
}

// The material, by the steps of the accuracy ladder. Exact is one walk, and so is Walk where it
// gets `one_walk`.
closure color all_closures(Frame frame, Microsurface surface, Facet facet, vector wi,
                           Accuracy accuracy, int one_walk, output RandomStream stream)
{
  closure color lobes = 0;
  Frame own = grounded(frame);
  int one = accuracy.quality == 3 || (accuracy.quality > 0 && one_walk);
  if (!one && accuracy.only < 2)
    lobes = first_bounce(own, surface, facet, accuracy.kernel, wi, stream);
  if (one
      || (accuracy.quality > 0 && accuracy.only != 1
          && has_further_bounces(surface, facet, wi, accuracy)))
    lobes = all_walks(own, surface, facet, wi, accuracy, one, stream) + lobes;
  return lobes;
}

#endif
