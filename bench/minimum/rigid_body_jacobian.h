/* rigid_body with its Jacobian by states and inputs, 66 nonzeros in compressed-column order. */
#ifndef MINIMUM_RIGID_BODY_JACOBIAN_H
#define MINIMUM_RIGID_BODY_JACOBIAN_H

typedef struct {
    double g[9][3];                            /* d omega_dot_i / d omega_j = g[3 j + i] . omega */
    double k_xx, k_yy, k_zz, k_xy, k_xz, k_yz; /* the inverse of I */
    double r_2;                                /* 2 / m */
} constants;

void setup(const double *p, constants *k);
void evaluate(const constants *k, const double *state, const double *F, const double *M,
              double *rate, double *jacobian);

#endif
