/* omega_dot of a free body, principal axes. */
#ifndef MINIMUM_FREE_BODY_PRINCIPAL_H
#define MINIMUM_FREE_BODY_PRINCIPAL_H

typedef struct {
    double a_x, a_y, a_z; /* (I_yy - I_zz) / I_xx and so on round */
    double k_x, k_y, k_z; /* 1 / I_xx and so on */
} constants;

void setup(const double *p, constants *k);
void evaluate(const constants *k, const double *w, const double *M, double *w_dot);

#endif
