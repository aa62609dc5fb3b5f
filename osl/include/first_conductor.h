// SPDX-License-Identifier: GPL-3.0-or-later
// The first bounce of metal.
#ifndef MICROBOUNCE_FIRST_CONDUCTOR_H
#define MICROBOUNCE_FIRST_CONDUCTOR_H

#include "reflection.h"

closure color first_bounce(Frame frame, Microsurface surface, Facet facet, float kernel, vector wi,
                           output RandomStream stream)
{
  return first_reflection(frame, surface, facet, wi, stream);
}

#endif
