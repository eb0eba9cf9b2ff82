/* The preprocessed discrete Moser-Veselov step of order 10 as it was published.
 *
 * Hairer and Vilmart, J. Phys. A 39 (2006) 13225; modified moments of inertia at every step, no
 * scaling, no compensation. Parameters: principal moments.
 */
#include "methods.h"
#include <math.h>

#define ROOT(x) ((real)sqrt((double)(x)))
#define SIZE(x) ((real)fabs((double)(x)))

static real I1, I2, I3, h, m[3], q[4];
static real S[5][5], D[5][5];

static real power(real x, int n)
{
    real y = 1;
    for (; n > 0; n--) {
        y *= x;
    }
    return y;
}

static real over(int n)
{
    return 1 / power(I1, n) + 1 / power(I2, n) + 1 / power(I3, n);
}

static real sum(int n)
{
    return power(I1, n) + power(I2, n) + power(I3, n);
}

static real X(int p, int r)
{
    return (power(I1, p) + power(I2, p)) / power(I3, r)
         + (power(I2, p) + power(I3, p)) / power(I1, r)
         + (power(I3, p) + power(I1, p)) / power(I2, r);
}

static int prepare(const double *given)
{
    I1 = (real)given[0], I2 = (real)given[1], I3 = (real)given[2];
    const real t = I1 * I2 * I3, x1 = over(1), x2 = over(2), x3 = over(3), x4 = over(4);
    const real s1 = sum(1), s2 = sum(2), s3 = sum(3), s4 = sum(4);
    const real t2 = t * t, t3 = t2 * t, t4 = t3 * t;
    S[1][0] = s1 / (6 * t), S[1][1] = -x1 / 3;
    D[1][0] = -1 / (3 * t), D[1][1] = s1 / (6 * t);
    S[2][0] = (s2 / t - x1) / (30 * t), S[2][1] = (1 - X(1, 1)) / (30 * t);
    S[2][2] = (3 * s1 / t + 2 * x2) / 60;
    D[2][0] = -s1 / (60 * t2), D[2][1] = x1 / (10 * t) - s2 / (60 * t2);
    D[2][2] = -(9 + X(1, 1)) / (60 * t);
    S[3][0] = (4 * t + 17 * s3 - 15 * t * X(1, 1)) / (2520 * t3);
    S[3][1] = (9 * s1 + 10 * t * x2 - 6 * X(2, 1)) / (420 * t2);
    S[3][2] = ((6 * X(1, 2) - 100 * x1) * t + 53 * s2) / (2520 * t2);
    S[3][3] = (15 - t * x3 - 2 * X(1, 1)) / (630 * t);
    D[3][0] = (34 * t * x1 - 19 * s2) / (2520 * t3);
    D[3][1] = (s3 + 2 * t * X(1, 1) - 85 * t) / (1260 * t3);
    D[3][2] = (47 * s1 + 13 * X(2, 1) - 38 * t * x2) / (2520 * t2);
    D[3][3] = (9 * t * x1 + t * X(1, 2) - 11 * s2) / (1260 * t2);
    S[4][0] = (62 * s4 - 94 * t * X(2, 1) + 66 * t2 * x2 + 81 * t * s1) / (45360 * t4);
    S[4][1] = (-77 * X(3, 1) + 75 * t * X(1, 2) + 214 * s2 - 240 * t * x1) / (22680 * t3);
    S[4][2] = (26 * t * X(2, 2) + 55 * s3 + 204 * t - 50 * t2 * x3 - 59 * t * X(1, 1)) / (7560 * t3);
    S[4][3] = (137 * t * x2 - t * X(1, 3) + 3 * s1 - 69 * X(2, 1)) / (11340 * t2);
    S[4][4] = (2 * t2 * x4 + 5 * t * X(1, 2) - 171 * t * x1 + 159 * s2) / (45360 * t2);
    D[4][0] = (60 * t * X(1, 1) - 61 * s3 - 247 * t) / (45360 * t4);
    D[4][1] = (54 * t * s1 - s4 + 218 * t * X(2, 1) - 426 * t2 * x2) / (45360 * t4);
    D[4][2] = (125 * t * x1 - 5 * X(3, 1) - 130 * s2 + 4 * t * X(1, 2)) / (7560 * t3);
    D[4][3] = (67 * s3 - 735 * t - 15 * t * X(2, 2) + 87 * t * X(1, 1) + 34 * t2 * x3) / (22680 * t3);
    D[4][4] = (165 * s1 - t * X(1, 3) - 9 * X(2, 1) - 145 * t * x2) / (45360 * t2);
    return 0;
}

static void start(const double *given, double step, double duration)
{
    (void)duration;
    for (int i = 0; i < 4; i++) {
        q[i] = (real)given[i];
    }
    m[0] = I1 * (real)given[4], m[1] = I2 * (real)given[5], m[2] = I3 * (real)given[6];
    h = (real)step;
}

static void state(double *to)
{
    for (int i = 0; i < 4; i++) {
        to[i] = (double)q[i];
    }
    to[4] = (double)(m[0] / I1), to[5] = (double)(m[1] / I2), to[6] = (double)(m[2] / I3);
}

static long dmv(long steps)
{
    for (long n = 0; n < steps; n++) {
        const real N = h * h * (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]) / 2;
        const real H = h * h * (m[0] * m[0] / I1 + m[1] * m[1] / I2 + m[2] * m[2] / I3) / 2;
        real s = 1, d = 0;
        for (int k = 1; k <= 4; k++) {
            for (int i = 0; i <= k; i++) {
                const real term = power(N, k - i) * power(H, i);
                s += S[k][i] * term;
                d += D[k][i] * term;
            }
        }
        const real a = 1 / (s / I1 + d), b = 1 / (s / I2 + d), c = 1 / (s / I3 + d);
        const real u = h / 2 * m[0] / a, v = h / 2 * m[1] / b, w = h / 2 * m[2] / c;
        const real x = (b - c) / a, y = (c - a) / b, z = (a - b) / c;
        real al = 1, c1 = u, c2 = v, c3 = w;
        for (int pass = 0; pass < 60; pass++) {
            const real before = c1 + c2 + c3;
            c1 = al * u + x * c2 * c3;
            c2 = al * v + y * c3 * c1;
            c3 = al * w + z * c1 * c2;
            al = 1 + c1 * c1 + c2 * c2 + c3 * c3;
            if (SIZE(c1 + c2 + c3 - before) == 0) {
                break;
            }
        }
        const real f = 4 / (h * al), r = 1 / ROOT(al);
        m[0] += f * (b - c) * c2 * c3;
        m[1] += f * (c - a) * c3 * c1;
        m[2] += f * (a - b) * c1 * c2;
        const real e = q[0], i = q[1], j = q[2], k = q[3];
        q[0] = (e - i * c1 - j * c2 - k * c3) * r;
        q[1] = (i + e * c1 + j * c3 - k * c2) * r;
        q[2] = (j + e * c2 + k * c1 - i * c3) * r;
        q[3] = (k + e * c3 + i * c2 - j * c1) * r;
    }
    return steps;
}

const method methods[] = {{prepare, start, dmv, state}};
