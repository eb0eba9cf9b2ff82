/* State phi, theta, psi (3-2-1), omega, relative wheel speeds: 64 flops, one of them a division,
 * two sines, two cosines. */
#include "gyrostat.h"

#include <math.h>

#include "inverse.h"

void setup(const double *p, constants *k)
{
    const symmetric I = tensor(p);
    const symmetric K = inverse(&I, p + 6);
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
    k->C_x = p[6];
    k->C_y = p[7];
    k->C_z = p[8];
    k->r_x = 1 / p[6];
    k->r_y = 1 / p[7];
    k->r_z = 1 / p[8];
}

void evaluate(const constants *k, const double *state, const double *M, const double *u,
              double *rate)
{
    const double s_phi = sin(state[0]), c_phi = cos(state[0]);
    const double s_theta = sin(state[1]), c_theta = cos(state[1]);
    const double x = state[3], y = state[4], z = state[5];
    const double across = s_phi * y + c_phi * z;
    const double psi_dot = across / c_theta;
    const double l_x = k->a * x + k->d * y + k->e * z + k->C_x * state[6];
    const double l_y = k->d * x + k->f * z + k->C_y * state[7];
    const double l_z = k->e * x + k->f * y + k->c * z + k->C_z * state[8];
    const double b_x = M[0] - u[0] - (y * l_z - z * l_y);
    const double b_y = M[1] - u[1] - (z * l_x - x * l_z);
    const double b_z = M[2] - u[2] - (x * l_y - y * l_x);
    const double x_dot = k->k_xx * b_x + k->k_xy * b_y + k->k_xz * b_z;
    const double y_dot = k->k_xy * b_x + k->k_yy * b_y + k->k_yz * b_z;
    const double z_dot = k->k_xz * b_x + k->k_yz * b_y + k->k_zz * b_z;
    rate[0] = x + psi_dot * s_theta;
    rate[1] = c_phi * y - s_phi * z;
    rate[2] = psi_dot;
    rate[3] = x_dot;
    rate[4] = y_dot;
    rate[5] = z_dot;
    rate[6] = k->r_x * u[0] - x_dot;
    rate[7] = k->r_y * u[1] - y_dot;
    rate[8] = k->r_z * u[2] - z_dot;
}
