// SPDX-License-Identifier: GPL-3.0-or-later
// The position-free random walk inside the microgeometry (Wang et al. 2022).
//
// A vertex receives the path from `v`, minus its direction of travel, and sends it to `o`. Sampling
// the visible normals leaves the Fresnel factor as the only weight, and the whole segment term is
// the chance to leave: G2(i=k) = G1dist(v) leave, G2(i<k) = G1dist(v) (1 - leave).
#ifndef MICROBOUNCE_WALK_H
#define MICROBOUNCE_WALK_H

#include "fresnel.h"
#include "ndf.h"
#include "random.h"
#include "smith.h"
#include "visible.h"

struct Vertex {
  vector o;      // direction in which the path goes on, local frame
  float cosine;  // between the ray and the micronormal, for the Fresnel factor
  float leave;   // chance that it leaves the surface in this direction
};

Vertex sample_vertex(Microsurface surface, Incidence arrival, vector u)
{
  Vertex vertex;
  vector m = sample_visible_normal(surface, arrival, u);
  vertex.cosine = clamp(dot(arrival.v, m), 0, 1);
  vertex.o = 2 * vertex.cosine * m - arrival.v;
  vertex.leave = exit_probability(surface, arrival, vertex.o);
  return vertex;
}

// One of `candidates` vertices, chosen in proportion to the energy that it keeps inside, with the
// mean of that energy in `kept`: walks are spent where the light is.
Vertex sample_kept_vertex(Microsurface surface, Incidence arrival, vector shift, int first,
                          int candidates, output RandomStream stream, output float kept)
{
  Vertex chosen;
  kept = 0;
  float threshold = next_number(stream);
  for (int i = first; i < first + candidates; ++i) {
    Vertex vertex = sample_vertex(surface, arrival, lattice_point(i, shift));
    float inside = 1 - vertex.leave;
    if (inside <= 0)
      continue;
    kept += inside;
    // Reservoir of one; the threshold is uniform again whichever way it falls.
    if (threshold * kept <= inside) {
      chosen = vertex;
      threshold *= kept / inside;
    }
    else
      threshold = (threshold * kept - inside) / (kept - inside);
  }
  kept /= candidates;
  return chosen;
}

// Follows a path that has made `bounces` bounces and is received from `v` until it leaves, and
// returns its direction; `throughput` is multiplied by the Fresnel factors on the way. At
// `max_bounces` only the part that leaves counts; a path that stays with less than `tolerance` is
// lost (throughput 0).
vector walk_to_exit(Microsurface surface, Conductor metal, vector v, int bounces, int max_bounces,
                    float tolerance, output RandomStream stream, output color throughput)
{
  vector from = v;
  for (int bounce = bounces + 1; bounce <= max_bounces; ++bounce) {
    Vertex vertex = sample_vertex(surface, incidence(surface, from), next_numbers(stream));
    throughput *= conductor_fresnel(metal, vertex.cosine);
    if (bounce == max_bounces) {
      throughput *= vertex.leave;
      return vertex.o;
    }
    if (next_number(stream) < vertex.leave)
      return vertex.o;
    if (max(throughput[0], max(throughput[1], throughput[2])) < tolerance)
      break;
    from = -vertex.o;
  }
  throughput = color(0);
  return vector(0, 0, 1);
}

#endif
