/* The set-up that the hand-written functions share: the inverse of a symmetric 3 x 3 tensor,
 * taken in quadruple precision and rounded once. */
#ifndef MINIMUM_INVERSE_H
#define MINIMUM_INVERSE_H

typedef __float128 real;

typedef struct {
    double xx, yy, zz, xy, xz, yz;
} symmetric;

/* Entries I_xx, I_yy, I_zz, -I_xy, -I_xz, -I_yz of a tensor from its moments and products. */
static inline symmetric tensor(const double p[6])
{
    symmetric t = {p[0], p[1], p[2], -p[3], -p[4], -p[5]};
    return t;
}

static const double none[3] = {0, 0, 0};

/* The inverse of t - diag(C); a difference of doubles would lose what a thin body has. */

static inline symmetric inverse(const symmetric *t, const double C[3])
{
    const real a = (real)t->xx - C[0], b = (real)t->yy - C[1], c = (real)t->zz - C[2];
    const real d = t->xy, e = t->xz, f = t->yz;
    const real A = b * c - f * f, D = e * f - d * c, E = d * f - b * e;
    const real k = 1 / (a * A + d * D + e * E);
    symmetric r;
    r.xx = (double)(k * A);
    r.yy = (double)(k * (a * c - e * e));
    r.zz = (double)(k * (a * b - d * d));
    r.xy = (double)(k * D);
    r.xz = (double)(k * E);
    r.yz = (double)(k * (d * e - a * f));
    return r;
}

#endif
