// SPDX-License-Identifier: GPL-3.0-or-later
// Walks as closures: the further bounces of Walk, and all bounces of Exact.
#ifndef MICROBOUNCE_WALKS_H
#define MICROBOUNCE_WALKS_H

#include "accuracy.h"
#include "exits.h"
#include "walk.h"

// Candidates for the first vertex of each walk. More make it less noisy, and cost a vertex each.
#define CANDIDATES 4

// Width of the exit if there is one walk alone, over the surface's and over `kernel`. Such paths
// go on at random anyway.
#define NARROW_KERNEL 0.1

// Walks, one closure each: `accuracy.walks` walks of the further bounces as smooth lobes, or `one`
// walk of all bounces. In Exact that one is singular.
closure color all_walks(Frame frame, Microsurface surface, Material material, vector wi,
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
      Vertex first = sample_kept_vertex(surface, material, arrival, walker, shift, i * CANDIDATES,
                                        CANDIDATES, stream, kept);
      if (kept <= 0)
        continue;
      walker.throughput = kept * scattering_factor(material, first.cosine);
      walker = stayed(surface, walker, first, stream);
      bounces = 1;
    }
    vector o = walk_to_exit(surface, material, bounces, accuracy.max_bounces, accuracy.only,
                            accuracy.tolerance, stream, walker);
    color weight = walker.throughput / walks;
    if (accuracy.quality == QUALITY_EXACT)
      lobes = weight * singular_exit(frame, material, wi, o, walker.below) + lobes;
    else
      lobes = smooth_exit(frame, surface, material, kernel, relative, wi, o, walker.below, weight)
              + lobes;
  }
  return lobes;
}

#endif
