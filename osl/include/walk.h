// SPDX-License-Identifier: GPL-3.0-or-later
// The position-free random walk inside the microgeometry (Wang et al. 2022), and the walk that
// carries its height (Heitz et al. 2016).
//
// A vertex receives the path from `v`, minus its direction of travel, and sends it to `o`. With
// visible normals as samples, the facet's factor is the only weight. The whole segment term is the
// chance to leave: G2(i=k) = G1dist(v) leave, G2(i<k) = G1dist(v) (1 - leave).
#ifndef MICROBOUNCE_WALK_H
#define MICROBOUNCE_WALK_H

#include "material.h"
#include "ndf.h"
#include "random.h"
#include "smith.h"
#include "visible.h"

// A path on its way to the next vertex, in the frame of its side (material.h).
struct Walker {
  vector v;
  int below;
  float log_u;  // height; of the height-tracked model alone
  color throughput;
};

struct Vertex {
  vector m;
  vector o;      // where the path goes next, in the frame of the side it is then on
  int crossed;   // whether that is the other side
  float cosine;  // between the ray and the facet
  float leave;   // chance that it leaves the surface in this direction
  float log_u;   // height seen from that side; of the height-tracked model alone
};

Walker walker_from(Microsurface surface, Incidence arrival, output RandomStream stream)
{
  Walker walker;
  walker.v = arrival.v;
  walker.below = 0;
  walker.log_u = 0;
  if (surface.model == HEIGHT_TRACKED)
    walker.log_u = height_met(arrival, next_number(stream));
  walker.throughput = color(1);
  return walker;
}

Vertex sample_vertex(Microsurface surface, Material material, Incidence arrival, Walker walker,
                     vector u, output RandomStream stream)
{
  Vertex vertex;
  vector extra = vector(0);
  if (material.kind != CONDUCTOR)
    extra = next_numbers(stream);
  vertex.m = sample_visible_normal(surface, arrival, u);
  vertex.cosine = clamp(dot(arrival.v, vertex.m), 0, 1);
  vertex.o = scattered(material, arrival.v, vertex.m, walker.below, vertex.cosine, extra[0],
                       extra[1], vertex.crossed);
  vertex.log_u = walker.log_u;
  if (surface.model == HEIGHT_TRACKED) {
    if (vertex.crossed)
      vertex.log_u = height_from_below(walker.log_u);
    vertex.leave = escape_chance(surface, vertex.o, vertex.log_u);
  }
  else
    vertex.leave = leave_probability(surface, arrival, vertex.o, vertex.crossed);
  return vertex;
}

// The path after a vertex where it stays.
Walker stayed(Microsurface surface, Walker walker, Vertex vertex, output RandomStream stream)
{
  Walker next = walker;
  next.v = -vertex.o;
  next.below = walker.below != vertex.crossed;
  if (surface.model == HEIGHT_TRACKED)
    next.log_u = next_height(surface, vertex.o, vertex.log_u, next_number(stream));
  return next;
}

// One of `candidates` vertices, chosen in proportion to the energy it keeps inside, so that walks
// go where the light is. `kept` is the mean of that energy.
Vertex sample_kept_vertex(Microsurface surface, Material material, Incidence arrival, Walker walker,
                          vector shift, int first, int candidates, output RandomStream stream,
                          output float kept)
{
  Vertex chosen;
  kept = 0;
  float threshold = next_number(stream);
  for (int i = first; i < first + candidates; ++i) {
    Vertex vertex =
        sample_vertex(surface, material, arrival, walker, lattice_point(i, shift), stream);
    float inside = 1 - vertex.leave;
    if (inside <= 0)
      continue;
    kept += inside;
    // Reservoir of one. The threshold is uniform again whichever way it falls.
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

// Follows a path after its first `bounces` bounces until it leaves. Returns its direction in the
// frame of the side it leaves on, `walker.below`, with its weight in `walker.throughput`. At
// `max_bounces` only the part that leaves counts. A path that stays with less than `tolerance` is
// lost (throughput 0). With `only` k > 0 the weight is what leaves at bounce k.
vector walk_to_exit(Microsurface surface, Material material, int bounces, int max_bounces, int only,
                    float tolerance, output RandomStream stream, output Walker walker)
{
  int last = (only > 0) ? only : max_bounces;
  for (int bounce = bounces + 1; bounce <= last; ++bounce) {
    Vertex vertex = sample_vertex(surface, material, incidence(surface, walker.v), walker,
                                  next_numbers(stream), stream);
    walker.throughput *= scattering_factor(material, vertex.cosine);
    int leaves = bounce == last;
    if (leaves)
      walker.throughput *= vertex.leave;
    else if (only > 0)
      walker.throughput *= 1 - vertex.leave;
    else
      leaves = next_number(stream) < vertex.leave;
    if (leaves) {
      walker.below = walker.below != vertex.crossed;
      return vertex.o;
    }
    if (max(walker.throughput[0], max(walker.throughput[1], walker.throughput[2])) < tolerance)
      break;
    walker = stayed(surface, walker, vertex, stream);
  }
  walker.throughput = color(0);
  return vector(0, 0, 1);
}

#endif
