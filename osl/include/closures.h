// SPDX-License-Identifier: GPL-3.0-or-later
// Cycles' closures as the model uses them: the first bounce, smoothed exits and singular exits.
#ifndef MICROBOUNCE_CLOSURES_H
#define MICROBOUNCE_CLOSURES_H

#include "frame.h"
#include "fresnel.h"
#include "ndf.h"
#include "walk.h"
#include "stdcycles.h"

// Candidates for the first vertex of each walk: more make it less noisy, and cost a vertex each.
#define CANDIDATES 4
// Widest exit relative to the surface: a wider one blurs narrow lobes, a narrower one is noise.
#define KERNEL_PER_ALPHA 0.5

string distribution_name(Microsurface surface)
{
  return surface.beckmann ? "beckmann" : "ggx";
}

// The first bounce: Cycles' height-correlated microfacet closure.
closure color first_bounce(Frame frame, Microsurface surface, Conductor metal)
{
  if (metal.physical)
    return conductor_bsdf(frame.z, frame.x, surface.alpha_x, surface.alpha_y, vector(metal.first),
                          vector(metal.second), distribution_name(surface));
  return microfacet_f82_tint(distribution_name(surface), frame.z, frame.x, surface.alpha_x,
                             surface.alpha_y, metal.first, metal.second);
}

// The part of a kernel that lies above the horizon: to first order a micronormal of slopes s about
// h moves the cosine o.z by 2 g.s, and the slopes are Gaussian with variance alpha^2 / 2.
float fraction_above_horizon(vector wi, float o_z, Frame lobe, float alpha_x, float alpha_y)
{
  float along = dot(wi, lobe.z);
  float gx = alpha_x * (dot(wi, lobe.x) * lobe.z[2] + along * lobe.x[2]);
  float gy = alpha_y * (dot(wi, lobe.y) * lobe.z[2] + along * lobe.y[2]);
  float spread = 2 * hypot(gx, gy);
  return (o_z < 4 * spread) ? 0.5 * (1 + erf(o_z / spread)) : 1;
}

// An exit towards `o` as a smooth lobe that takes part in light sampling: a Beckmann microfacet
// lobe about the half vector, as anisotropic as the surface. Its single bounce loses next to
// nothing to masking at these widths; what falls below the horizon is given back to the rest.
closure color smoothed_exit(Frame frame, Microsurface surface, float kernel, vector wi, vector o,
                            color weight)
{
  float alpha_x = min(0.5 * kernel, KERNEL_PER_ALPHA * surface.alpha_x);
  float alpha_y = min(0.5 * kernel, KERNEL_PER_ALPHA * surface.alpha_y);
  Frame lobe = shading_frame(normalize(wi + o), vector(1, 0, 0));
  float above = fraction_above_horizon(wi, o[2], lobe, alpha_x, alpha_y);
  return (weight / above) * microfacet("beckmann", to_world(frame, lobe.z), to_world(frame, lobe.x),
                                       alpha_x, alpha_y, 1, 0);
}

// All further bounces: `walks` walks, each of them one smooth lobe.
closure color further_bounces(Frame frame, Microsurface surface, Conductor metal, vector wi,
                              int max_bounces, float tolerance, int walks, float kernel,
                              output RandomStream stream)
{
  closure color lobes = 0;
  Incidence arrival = incidence(surface, wi);
  vector shift = next_numbers(stream);
  for (int i = 0; i < walks; ++i) {
    float kept;
    Vertex first =
        sample_kept_vertex(surface, arrival, shift, i * CANDIDATES, CANDIDATES, stream, kept);
    if (kept <= 0)
      continue;
    color throughput = kept * conductor_fresnel(metal, first.cosine);
    vector o =
        walk_to_exit(surface, metal, -first.o, 1, max_bounces, tolerance, stream, throughput);
    lobes = smoothed_exit(frame, surface, kernel, wi, o, throughput / walks) + lobes;
  }
  return lobes;
}

// Every bounce of one walk as a mirror that turns the view to the exit: unbiased and without a
// kernel, but lights are only found by being hit.
closure color singular_walk(Frame frame, Microsurface surface, Conductor metal, vector wi,
                            int max_bounces, float tolerance, output RandomStream stream)
{
  color throughput = 1;
  vector o = walk_to_exit(surface, metal, wi, 0, max_bounces, tolerance, stream, throughput);
  return throughput * reflection(to_world(frame, normalize(wi + o)));
}

#endif
