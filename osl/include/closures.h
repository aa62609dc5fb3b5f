// SPDX-License-Identifier: GPL-3.0-or-later
// All bounces of a material as a sum of Cycles' closures: the steps of the accuracy ladder. What
// the material's `first_bounce` is, the shader says by the header that it includes before:
// first_conductor.h, first_dielectric.h or first_diffuse.h. As a render starts, OSL reads all code,
// whether it is needed or not, so that a shader has that of its own material alone.
#ifndef MICROBOUNCE_CLOSURES_H
#define MICROBOUNCE_CLOSURES_H

#include "accuracy.h"
#include "exits.h"
#include "walk.h"

// Candidates for the first vertex of each walk: more make it less noisy, and cost a vertex each.
#define CANDIDATES 4

// Widths of the exits of whole walks: relative to the surface's, and of those in `kernel`.
#define NARROW_KERNEL 0.1

// Walks, each of them one closure: `accuracy.walks` of the further bounces, as smooth lobes. Or, if
// `whole`, one of every bounce: going exactly to its exit in Exact, else as a lobe much narrower
// than the surface's.
closure color all_walks(Frame frame, Microsurface surface, Facet facet, vector wi,
                        Accuracy accuracy, int whole, output RandomStream stream)
{
  closure color lobes = 0;
  Incidence arrival = incidence(surface, wi);
  int walks = whole ? 1 : accuracy.walks;
  float kernel = whole ? NARROW_KERNEL * accuracy.kernel : accuracy.kernel;
  float relative = whole ? NARROW_KERNEL : KERNEL_PER_ALPHA;
  vector shift = whole ? vector(0) : next_numbers(stream);
  for (int i = 0; i < walks; ++i) {
    Walker walker = walker_from(surface, arrival, stream);
    if (!whole) {
      float kept;
      Vertex first = sample_kept_vertex(surface, facet, arrival, walker, shift, i * CANDIDATES,
                                        CANDIDATES, stream, kept);
      if (kept <= 0)
        continue;
      walker.throughput = kept * facet_weight(facet, first.cosine);
      walker = stayed(surface, walker, first, stream);
    }
    vector o = walk_to_exit(surface, facet, !whole, accuracy.max_bounces, accuracy.only,
                            accuracy.tolerance, stream, walker);
    if (accuracy.quality == 3)
      lobes = walker.throughput * singular_exit(frame, facet, wi, o, walker.below);
    else
      lobes = smooth_exit(frame, surface, facet, kernel, relative, wi, o, walker.below,
                          walker.throughput / walks)
              + lobes;
  }
  return lobes;
}

// The material, by the steps of the accuracy ladder. Where it is `unseen`, after bounces that have
// spread a path already, one walk is enough.
closure color all_closures(Frame frame, Microsurface surface, Facet facet, vector wi,
                           Accuracy accuracy, int unseen, output RandomStream stream)
{
  closure color lobes = 0;
  Frame own = grounded(frame);
  int whole = accuracy.quality == 3 || (accuracy.quality > 0 && unseen);
  if (!whole && accuracy.only < 2)
    lobes = first_bounce(own, surface, facet, accuracy.kernel, wi, stream);
  if (whole
      || (accuracy.quality > 0 && accuracy.only != 1
          && has_further_bounces(surface, facet, wi, accuracy)))
    lobes = all_walks(own, surface, facet, wi, accuracy, whole, stream) + lobes;
  return lobes;
}

#endif
