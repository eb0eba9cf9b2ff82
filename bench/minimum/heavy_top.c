/* State psi, theta, phi, omega along the line of nodes, across it, along the axis of the top:
 * 9 flops, one of them a division, one sine, one cosine. */
#include "heavy_top.h"

#include <math.h>

void setup(const double *p, constants *k)
{
    k->ratio = p[1] / p[0];
    k->weight = p[2] * p[3] * p[4] / p[0];
}

void evaluate(const constants *k, const double *state, double *rate)
{
    const double x = state[3], y = state[4], z = state[5];
    const double s = sin(state[1]);
    const double c = cos(state[1]);
    const double precession = y / s;
    const double turn = precession * c;
    const double gyroscopic = k->ratio * z - turn;
    rate[0] = precession;
    rate[1] = x;
    rate[2] = z - turn;
    rate[3] = k->weight * s - gyroscopic * y;
    rate[4] = gyroscopic * x;
    rate[5] = 0;
}
