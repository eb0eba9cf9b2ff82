/* State position, quaternion (scalar first), velocity, omega: 96 flops, no division. */
#include "rigid_body.h"

#include <string.h>

#include "inverse.h"

void setup(const double *p, constants *k)
{
    const symmetric I = tensor(p + 1);
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
    k->r = 1 / p[0];
    k->r_2 = 2 / p[0];
}

static void velocity_rate(const constants *k, const double *q, const double *F, double *v_dot);
static void attitude_rate(const double *q, const double *w, double *q_dot);
static void spin_rate(const constants *k, const double *w, const double *M, double *w_dot);

void evaluate(const constants *k, const double *state, const double *F, const double *M,
              double *rate)
{
    const double q[4] = {state[3], state[4], state[5], state[6]};
    const double v[3] = {state[7], state[8], state[9]};
    const double w[3] = {state[10], state[11], state[12]};
    double q_dot[4], v_dot[3], w_dot[3];
    attitude_rate(q, w, q_dot);
    velocity_rate(k, q, F, v_dot);
    spin_rate(k, w, M, w_dot);
    memcpy(rate, v, sizeof v);
    memcpy(&rate[3], q_dot, sizeof q_dot);
    memcpy(&rate[7], v_dot, sizeof v_dot);
    memcpy(&rate[10], w_dot, sizeof w_dot);
}

static void velocity_rate(const constants *k, const double *q, const double *F, double *v_dot)
{
    const double g_x = k->r_2 * F[0], g_y = k->r_2 * F[1], g_z = k->r_2 * F[2];
    const double t_x = q[2] * g_z - q[3] * g_y + q[0] * g_x;
    const double t_y = q[3] * g_x - q[1] * g_z + q[0] * g_y;
    const double t_z = q[1] * g_y - q[2] * g_x + q[0] * g_z;
    v_dot[0] = k->r * F[0] + (q[2] * t_z - q[3] * t_y);
    v_dot[1] = k->r * F[1] + (q[3] * t_x - q[1] * t_z);
    v_dot[2] = k->r * F[2] + (q[1] * t_y - q[2] * t_x);
}

static void attitude_rate(const double *q, const double *w, double *q_dot)
{
    const double x = 0.5 * w[0], y = 0.5 * w[1], z = 0.5 * w[2];
    q_dot[0] = -q[1] * x - q[2] * y - q[3] * z;
    q_dot[1] = q[0] * x + q[2] * z - q[3] * y;
    q_dot[2] = q[0] * y + q[3] * x - q[1] * z;
    q_dot[3] = q[0] * z + q[1] * y - q[2] * x;
}

static void spin_rate(const constants *k, const double *w, const double *M, double *w_dot)
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
