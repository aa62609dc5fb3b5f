// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers of one shading point. The same point and view give the same numbers again.
#ifndef MICROBOUNCE_RANDOM_H
#define MICROBOUNCE_RANDOM_H

struct RandomStream {
  point origin;
  float counter;
};

// The pixel filter moves P from sample to sample, so each sample gets its own numbers. The view
// separates paths that meet in one point.
RandomStream random_stream(point position, vector view)
{
  RandomStream stream;
  float offset = hashnoise(point(view));
  stream.origin = position;
  stream.counter = floor(65536 * offset);
  return stream;
}

// One number, uniform in [0, 1].
float next_number(output RandomStream stream)
{
  stream.counter += 1;
  return hashnoise(stream.origin, stream.counter);
}

// Three independent numbers, uniform in [0, 1].
vector next_numbers(output RandomStream stream)
{
  stream.counter += 1;
  vector u = hashnoise(stream.origin, stream.counter);
  return u;
}

// Point `index` of a rank-1 lattice in the unit cube, moved by the random `shift`. Points of
// consecutive indices spread evenly (steps of the generalised golden ratio in three dimensions,
// Roberts 2018).
vector lattice_point(int index, vector shift)
{
  vector u = shift + index * vector(0.8191725134, 0.6710436067, 0.5497004779);
  return u - floor(u);
}

#endif
