// SPDX-License-Identifier: GPL-3.0-or-later
// The first bounce of glass, on both sides.
#ifndef MICROBOUNCE_FIRST_DIELECTRIC_H
#define MICROBOUNCE_FIRST_DIELECTRIC_H

#include "refraction.h"

closure color first_bounce(Frame frame, Microsurface surface, Facet facet, float kernel, vector wi,
                           output RandomStream stream)
{
  closure color lobes = first_reflection(frame, surface, facet, wi, stream);
  return first_refraction(frame, surface, facet, wi, FACETS, stream) + lobes;
}

#endif
