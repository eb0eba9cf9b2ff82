/* omega_dot = K (M - omega x (I - I_yy 1) omega): 40 flops, no division. */
#include "free_body.h"

#include "inverse.h"

void setup(const double *p, constants *k)
{
    const symmetric I = tensor(p);
    const symmetric K = inverse(&I, none);
    k->a = I.xx - I.yy;
    k->c = I.zz - I.yy;
    k->d = I.xy;
    k->e = I.xz;
    k->f = I.yz;
    k->k_xx = K.xx;
    k->k_yy = K.yy;
    k->k_zz = K.zz;
    k->k_xy = K.xy;
    k->k_xz = K.xz;
    k->k_yz = K.yz;
}

void evaluate(const constants *k, const double *w, const double *M, double *w_dot)
{
    const double x = w[0], y = w[1], z = w[2];
    const double l_x = k->a * x + k->d * y + k->e * z;
    const double l_y = k->d * x + k->f * z;
    const double l_z = k->e * x + k->f * y + k->c * z;
    const double b_x = M[0] - (y * l_z - z * l_y);
    const double b_y = M[1] - (z * l_x - x * l_z);
    const double b_z = M[2] - (x * l_y - y * l_x);
    w_dot[0] = k->k_xx * b_x + k->k_xy * b_y + k->k_xz * b_z;
    w_dot[1] = k->k_xy * b_x + k->k_yy * b_y + k->k_yz * b_z;
    w_dot[2] = k->k_xz * b_x + k->k_yz * b_y + k->k_zz * b_z;
}
