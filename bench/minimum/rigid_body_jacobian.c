/* Rates and Jacobian: 170 flops, no division. R F / m with R = (q_w^2 - |q_v|^2) 1 + ..., so that
 * its derivative by q has four magnitudes; d omega_dot / d omega is linear in omega, and
 * omega_dot - K M is half of it times omega. */
#include "rigid_body_jacobian.h"

#include <string.h>

#include "inverse.h"

#ifdef DENSE
/* The whole matrix of 13 by 19, column by column: where each entry that is not zero stands. */
static const unsigned char at[66] = {
    43, 44, 45, 46, 47, 48, 55, 57, 58, 59, 60, 61, 68, 69, 71, 72, 73, 74, 81, 82, 83, 85,
    86, 87, 91, 105, 119, 133, 134, 135, 136, 140, 141, 142, 146, 147, 148, 149, 153, 154,
    155, 159, 160, 161, 162, 166, 167, 168, 176, 177, 178, 189, 190, 191, 202, 203, 204,
    218, 219, 220, 231, 232, 233, 244, 245, 246};
#define J(n) jacobian[at[n]]
#define CLEAR memset(jacobian, 0, 247 * sizeof *jacobian)
#else
#define J(n) jacobian[n]
#define CLEAR (void)0
#endif

static void gyroscopic(const real I[3][3], const double w[3], real out[3][3])
{
    /* d (-omega x I omega) / d omega_j = -e_j x I omega - omega x I e_j, with I - I_yy 1 for I. */
    real l[3];
    for (int i = 0; i < 3; i++) {
        l[i] = I[i][0] * w[0] + I[i][1] * w[1] + I[i][2] * w[2];
    }
    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < 3; i++) {
            const int n = (i + 1) % 3, o = (i + 2) % 3;
            const real first = (n == j ? l[o] : 0) - (o == j ? l[n] : 0);
            out[i][j] = -first - (w[n] * I[o][j] - w[o] * I[n][j]);
        }
    }
}

static void solve(const real I[3][3], const real b[3], real x[3])
{
    const real A = I[1][1] * I[2][2] - I[1][2] * I[1][2];
    const real D = I[0][2] * I[1][2] - I[0][1] * I[2][2];
    const real E = I[0][1] * I[1][2] - I[1][1] * I[0][2];
    const real B = I[0][0] * I[2][2] - I[0][2] * I[0][2];
    const real C = I[0][0] * I[1][1] - I[0][1] * I[0][1];
    const real G = I[0][1] * I[0][2] - I[0][0] * I[1][2];
    const real k = 1 / (I[0][0] * A + I[0][1] * D + I[0][2] * E);
    x[0] = k * (A * b[0] + D * b[1] + E * b[2]);
    x[1] = k * (D * b[0] + B * b[1] + G * b[2]);
    x[2] = k * (E * b[0] + G * b[1] + C * b[2]);
}

void setup(const double *p, constants *k)
{
    const symmetric t = tensor(p + 1);
    const symmetric K = inverse(&t, none);
    const real I[3][3] = {{t.xx, t.xy, t.xz}, {t.xy, t.yy, t.yz}, {t.xz, t.yz, t.zz}};
    real shifted[3][3];
    memcpy(shifted, I, sizeof shifted);
    for (int i = 0; i < 3; i++) {
        shifted[i][i] -= I[1][1];
    }
    for (int n = 0; n < 3; n++) {
        const double w[3] = {n == 0, n == 1, n == 2};
        real d[3][3];
        gyroscopic(shifted, w, d);
        for (int j = 0; j < 3; j++) {
            const real b[3] = {d[0][j], d[1][j], d[2][j]};
            real x[3];
            solve(I, b, x);
            for (int i = 0; i < 3; i++) {
                k->g[3 * j + i][n] = (double)x[i];
            }
        }
    }
    k->k_xx = K.xx;
    k->k_yy = K.yy;
    k->k_zz = K.zz;
    k->k_xy = K.xy;
    k->k_xz = K.xz;
    k->k_yz = K.yz;
    k->r_2 = 2 / p[0];
}

void evaluate(const constants *k, const double *state, const double *F, const double *M,
              double *rate, double *jacobian)
{
    const double w = state[3], x = state[4], y = state[5], z = state[6];
    const double p_x = state[10], p_y = state[11], p_z = state[12];
    const double F_x = F[0], F_y = F[1], F_z = F[2], M_x = M[0], M_y = M[1], M_z = M[2];
    /* attitude: half quaternion, half rates */
    const double hw = 0.5 * w, hx = 0.5 * x, hy = 0.5 * y, hz = 0.5 * z;
    const double o_x = 0.5 * p_x, o_y = 0.5 * p_y, o_z = 0.5 * p_z;
    /* d v_dot / d q: four magnitudes */
    const double g_x = k->r_2 * F_x, g_y = k->r_2 * F_y, g_z = k->r_2 * F_z;
    const double a_x = w * g_x + (y * g_z - z * g_y);
    const double a_y = w * g_y + (z * g_x - x * g_z);
    const double a_z = w * g_z + (x * g_y - y * g_x);
    const double b = x * g_x + y * g_y + z * g_z;
    /* R / m */
    const double t_w = k->r_2 * w, t_x = k->r_2 * x, t_y = k->r_2 * y, t_z = k->r_2 * z;
    const double ww = t_w * hw, xx = t_x * hx, yy = t_y * hy, zz = t_z * hz;
    const double xy = t_x * y, xz = t_x * z, yz = t_y * z;
    const double wx = t_x * w, wy = t_y * w, wz = t_z * w;
    const double outer = ww - xx, inner = yy - zz;
    const double r_xx = (ww + xx) - (yy + zz), r_yy = outer + inner, r_zz = outer - inner;
    const double r_xy = xy - wz, r_xz = xz + wy, r_yz = yz - wx;
    const double r_yx = xy + wz, r_zx = xz - wy, r_zy = yz + wx;
    /* d omega_dot / d omega */
    const double d_xx = k->g[0][0] * p_x + k->g[0][1] * p_y + k->g[0][2] * p_z;
    const double d_yx = k->g[1][0] * p_x + k->g[1][1] * p_y + k->g[1][2] * p_z;
    const double d_zx = k->g[2][0] * p_x + k->g[2][1] * p_y + k->g[2][2] * p_z;
    const double d_xy = k->g[3][0] * p_x + k->g[3][1] * p_y + k->g[3][2] * p_z;
    const double d_yy = k->g[4][0] * p_x + k->g[4][1] * p_y + k->g[4][2] * p_z;
    const double d_zy = k->g[5][0] * p_x + k->g[5][1] * p_y + k->g[5][2] * p_z;
    const double d_xz = k->g[6][0] * p_x + k->g[6][1] * p_y + k->g[6][2] * p_z;
    const double d_yz = k->g[7][0] * p_x + k->g[7][1] * p_y + k->g[7][2] * p_z;
    const double d_zz = k->g[8][0] * p_x + k->g[8][1] * p_y + k->g[8][2] * p_z;
    const double half_x = d_xx * o_x + d_xy * o_y + d_xz * o_z;
    const double half_y = d_yx * o_x + d_yy * o_y + d_yz * o_z;
    const double half_z = d_zx * o_x + d_zy * o_y + d_zz * o_z;

    rate[0] = state[7];
    rate[1] = state[8];
    rate[2] = state[9];
    rate[3] = -hx * p_x - hy * p_y - hz * p_z;
    rate[4] = hw * p_x + hy * p_z - hz * p_y;
    rate[5] = hw * p_y + hz * p_x - hx * p_z;
    rate[6] = hw * p_z + hx * p_y - hy * p_x;
    rate[7] = r_xx * F_x + r_xy * F_y + r_xz * F_z;
    rate[8] = r_yx * F_x + r_yy * F_y + r_yz * F_z;
    rate[9] = r_zx * F_x + r_zy * F_y + r_zz * F_z;
    rate[10] = (k->k_xx * M_x + k->k_xy * M_y + k->k_xz * M_z) + half_x;
    rate[11] = (k->k_xy * M_x + k->k_yy * M_y + k->k_yz * M_z) + half_y;
    rate[12] = (k->k_xz * M_x + k->k_yz * M_y + k->k_zz * M_z) + half_z;

    CLEAR;
    /* by q_w: q_x, q_y, q_z, v */
    J(0) = o_x, J(1) = o_y, J(2) = o_z;
    J(3) = a_x, J(4) = a_y, J(5) = a_z;
    /* by q_x: q_w, q_y, q_z, v */
    J(6) = -o_x, J(7) = -o_z, J(8) = o_y;
    J(9) = b, J(10) = -a_z, J(11) = a_y;
    /* by q_y: q_w, q_x, q_z, v */
    J(12) = -o_y, J(13) = o_z, J(14) = -o_x;
    J(15) = a_z, J(16) = b, J(17) = -a_x;
    /* by q_z: q_w, q_x, q_y, v */
    J(18) = -o_z, J(19) = -o_y, J(20) = o_x;
    J(21) = -a_y, J(22) = a_x, J(23) = b;
    /* by v: p */
    J(24) = 1, J(25) = 1, J(26) = 1;
    /* by omega: q, omega */
    J(27) = -hx, J(28) = hw, J(29) = hz, J(30) = -hy;
    J(31) = d_xx, J(32) = d_yx, J(33) = d_zx;
    J(34) = -hy, J(35) = -hz, J(36) = hw, J(37) = hx;
    J(38) = d_xy, J(39) = d_yy, J(40) = d_zy;
    J(41) = -hz, J(42) = hy, J(43) = -hx, J(44) = hw;
    J(45) = d_xz, J(46) = d_yz, J(47) = d_zz;
    /* by F: v */
    J(48) = r_xx, J(49) = r_yx, J(50) = r_zx;
    J(51) = r_xy, J(52) = r_yy, J(53) = r_zy;
    J(54) = r_xz, J(55) = r_yz, J(56) = r_zz;
    /* by M: omega */
    J(57) = k->k_xx, J(58) = k->k_xy, J(59) = k->k_xz;
    J(60) = k->k_xy, J(61) = k->k_yy, J(62) = k->k_yz;
    J(63) = k->k_xz, J(64) = k->k_yz, J(65) = k->k_zz;
}
