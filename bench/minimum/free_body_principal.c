/* omega_dot_x = a_x omega_y omega_z + k_x M_x and so on round: 12 flops, no division. */
#include "free_body_principal.h"

void setup(const double *p, constants *k)
{
    k->a_x = (p[1] - p[2]) / p[0];
    k->a_y = (p[2] - p[0]) / p[1];
    k->a_z = (p[0] - p[1]) / p[2];
    k->k_x = 1 / p[0];
    k->k_y = 1 / p[1];
    k->k_z = 1 / p[2];
}

void evaluate(const constants *k, const double *w, const double *M, double *w_dot)
{
    const double x = w[0], y = w[1], z = w[2];
    w_dot[0] = k->a_x * y * z + k->k_x * M[0];
    w_dot[1] = k->a_y * z * x + k->k_y * M[1];
    w_dot[2] = k->a_z * x * y + k->k_z * M[2];
}
