/* Rates of the nine states of a carrier with wheels on its x, y and z axes. */
#ifndef MINIMUM_GYROSTAT_H
#define MINIMUM_GYROSTAT_H

typedef struct {
    double a, c, d, e, f;                      /* I - I_yy 1: xx, zz, xy, xz, yz */
    double k_xx, k_yy, k_zz, k_xy, k_xz, k_yz; /* the inverse of I - diag(C) */
    double C_x, C_y, C_z;                      /* axial moments of the wheels */
    double r_x, r_y, r_z;                      /* 1 / C */
} constants;

void setup(const double *p, constants *k);
void evaluate(const constants *k, const double *state, const double *M, const double *u,
              double *rate);

#endif
