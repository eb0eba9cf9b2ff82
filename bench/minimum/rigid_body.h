/* Rates of the thirteen states of a free body; force and moment along the body's axes. */
#ifndef MINIMUM_RIGID_BODY_H
#define MINIMUM_RIGID_BODY_H

typedef struct {
    double a, c, d, e, f;                      /* I - I_yy 1: xx, zz, xy, xz, yz */
    double k_xx, k_yy, k_zz, k_xy, k_xz, k_yz; /* the inverse of I */
    double r, r_2;                             /* 1 / m, 2 / m */
} constants;

void setup(const double *p, constants *k);
void evaluate(const constants *k, const double *state, const double *F, const double *M,
              double *rate);

#endif
