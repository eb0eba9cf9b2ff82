/* What textbooks give: RK4 with the quaternion normalised after each step, and DOP853.
 *
 * y = (attitude, omega). Parameters: tensor entries xx yy zz xy xz yz, constant moment, momentum of
 * wheels, weight times place of the mass centre; PRODUCTS, MOMENT, WHEEL, WEIGHT say which there are.
 */
#include "methods.h"
#include <math.h>

#define N 7
#define ROOT(x) ((real)sqrt((double)(x)))
#define POWER(x, y) ((real)pow((double)(x), (double)(y)))

static real A, B, C, J[6], differences[3], moment[3], wheel[3], weight[3];
static real y[N], h;
static double end_time; /* times are added up in double, whatever real is */

#ifdef PRODUCTS
static real D, E, F;
#endif

static int prepare(const double *p)
{
    A = (real)p[0], B = (real)p[1], C = (real)p[2];
#ifdef PRODUCTS
    D = (real)p[3], E = (real)p[4], F = (real)p[5];
    const real xx = B * C - F * F, yy = A * C - E * E, zz = A * B - D * D;
    const real xy = E * F - D * C, xz = D * F - B * E, yz = D * E - A * F;
    const real determinant = A * xx + D * xy + E * xz;
    const real cofactors[6] = {xx, yy, zz, xy, xz, yz};
    for (int i = 0; i < 6; i++) {
        J[i] = cofactors[i] / determinant;
    }
#else
    J[0] = 1 / A, J[1] = 1 / B, J[2] = 1 / C;
#endif
    differences[0] = B - C, differences[1] = C - A, differences[2] = A - B;
    for (int i = 0; i < 3; i++) {
        moment[i] = (real)p[6 + i];
        wheel[i] = (real)p[9 + i];
        weight[i] = (real)p[12 + i];
    }
    return 0;
}

static inline void rate(const real *s, real *d)
{
    const real a = s[0], b = s[1], c = s[2], e = s[3], x = s[4], y_ = s[5], z = s[6];
    const real half = (real)0.5;
    d[0] = -half * (b * x + c * y_ + e * z);
    d[1] = half * (a * x + c * z - e * y_);
    d[2] = half * (a * y_ + e * x - b * z);
    d[3] = half * (a * z + b * y_ - c * x);
#ifdef PRODUCTS
    const real l = A * x + D * y_ + E * z, m = D * x + B * y_ + F * z, n = E * x + F * y_ + C * z;
    real t0 = m * z - n * y_, t1 = n * x - l * z, t2 = l * y_ - m * x;
#else
    real t0 = differences[0] * y_ * z, t1 = differences[1] * z * x, t2 = differences[2] * x * y_;
#endif
#ifdef MOMENT
    t0 += moment[0], t1 += moment[1], t2 += moment[2];
#endif
#ifdef WHEEL
    t0 += wheel[1] * z - wheel[2] * y_;
    t1 += wheel[2] * x - wheel[0] * z;
    t2 += wheel[0] * y_ - wheel[1] * x;
#endif
#ifdef WEIGHT
    const real u = 2 * (b * e - a * c), v = 2 * (c * e + a * b), w = a * a - b * b - c * c + e * e;
    t0 += v * weight[2] - w * weight[1];
    t1 += w * weight[0] - u * weight[2];
    t2 += u * weight[1] - v * weight[0];
#endif
#ifdef PRODUCTS
    d[4] = J[0] * t0 + J[3] * t1 + J[4] * t2;
    d[5] = J[3] * t0 + J[1] * t1 + J[5] * t2;
    d[6] = J[4] * t0 + J[5] * t1 + J[2] * t2;
#else
    d[4] = J[0] * t0;
    d[5] = J[1] * t1;
    d[6] = J[2] * t2;
#endif
}

static void start(const double *given, double step, double duration)
{
    for (int i = 0; i < N; i++) {
        y[i] = (real)given[i];
    }
    h = (real)step;
    end_time = duration;
}

static void state(double *to)
{
    for (int i = 0; i < N; i++) {
        to[i] = (double)y[i];
    }
}

static long rk4(long steps)
{
    for (long n = 0; n < steps; n++) {
        real k1[N], k2[N], k3[N], k4[N], s[N];
        rate(y, k1);
        for (int i = 0; i < N; i++) {
            s[i] = y[i] + h / 2 * k1[i];
        }
        rate(s, k2);
        for (int i = 0; i < N; i++) {
            s[i] = y[i] + h / 2 * k2[i];
        }
        rate(s, k3);
        for (int i = 0; i < N; i++) {
            s[i] = y[i] + h * k3[i];
        }
        rate(s, k4);
        for (int i = 0; i < N; i++) {
            y[i] += h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
        }
        const real length = 1 / ROOT(y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3]);
        for (int i = 0; i < 4; i++) {
            y[i] *= length;
        }
    }
    return steps;
}

#include "dop853.h"

static inline real squares(const real *a, const real *scale)
{
    real sum = 0;
    for (int i = 0; i < N; i++) {
        sum += (a[i] / scale[i]) * (a[i] / scale[i]);
    }
    return sum;
}

/* As SciPy does it, but without its output between steps; h is the relative tolerance. */
static long dop853(long unused)
{
    const real tolerance = h;
    real k[13][N], next[N], err5[N], err3[N], scale[N];
    const real turning = ROOT(y[4] * y[4] + y[5] * y[5] + y[6] * y[6]);
    double left = end_time;
    real step = POWER(tolerance, 0.125) / turning;
    long attempts = 0;
    (void)unused;
    rate(y, k[0]);
    while (left > 0) {
        step = (double)step < left ? step : (real)left;
        attempts++;
        dop853_stages(step, y, k, next, err5, err3);
        for (int i = 0; i < N; i++) {
            const real a = y[i] < 0 ? -y[i] : y[i], b = next[i] < 0 ? -next[i] : next[i];
            const real size = i < 4 ? 1 : turning;
            scale[i] = tolerance * (size > a ? size : (a > b ? a : b));
        }
        const real five = squares(err5, scale), three = squares(err3, scale);
        const real below = (five + (real)0.01 * three) * N;
        const real error = below > 0 ? step * five / ROOT(below) : 0;
        if (error < 1) {
            left = (double)step < left ? left - (double)step : 0;
            for (int i = 0; i < N; i++) {
                y[i] = next[i];
                k[0][i] = k[12][i];
            }
            const real factor = error > 0 ? (real)0.9 * POWER(error, -0.125) : 10;
            step *= factor < 10 ? factor : 10;
        } else {
            const real factor = (real)0.9 * POWER(error, -0.125);
            step *= factor > (real)0.2 ? factor : (real)0.2;
        }
        if (attempts > 100000000L) {
            break;
        }
    }
    return attempts;
}

const method methods[] = {{prepare, start, rk4, state}, {prepare, start, dop853, state}};
