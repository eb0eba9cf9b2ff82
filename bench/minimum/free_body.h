/* omega_dot of a free body, full tensor, body axes. */
#ifndef MINIMUM_FREE_BODY_H
#define MINIMUM_FREE_BODY_H

typedef struct {
    double a, c, d, e, f;                      /* I - I_yy 1: xx, zz, xy, xz, yz */
    double k_xx, k_yy, k_zz, k_xy, k_xz, k_yz; /* the inverse of I */
} constants;

void setup(const double *p, constants *k);
void evaluate(const constants *k, const double *w, const double *M, double *w_dot);

#endif
