/* Sine, cosine and arctangent in the place of the C library's, which differ from one machine to
 * another: what is compared is what the scene's functions make of them. Near the true ones. */
#define TAU ((scalar)6.283185307179586)

static scalar turned(scalar x)
{
    const scalar turns = x / TAU;
    return x - TAU * (scalar)(int)(turns + (turns < 0 ? (scalar)-0.5 : (scalar)0.5));
}

static scalar series(scalar x, scalar term, int first)
{
    scalar sum = term;
    for (int n = first; n < 24; n += 2) {
        term = -term * x * x / (scalar)(n * (n + 1));
        sum += term;
    }
    return sum;
}

static scalar sine(scalar x) { return series(turned(x), turned(x), 2); }

static scalar cosine(scalar x) { return series(turned(x), 1, 1); }

/* By Newton's method, from the quadrant's middle. */
static scalar arctangent(scalar y, scalar x)
{
    scalar angle = x < 0 ? (y < 0 ? (scalar)-2.4 : (scalar)2.4) : (y < 0 ? (scalar)-0.8 : (scalar)0.8);
    const scalar size = (x < 0 ? -x : x) + (y < 0 ? -y : y);
    for (int n = 0; n < 8 && size > 0; n++) {
        const scalar s = sine(angle);
        const scalar c = cosine(angle);
        angle += (y * c - x * s) / (x * c + y * s);
    }
    return angle;
}

#if defined(SINGLE)
float sinf(float x) { return sine(x); }
float cosf(float x) { return cosine(x); }
float atan2f(float y, float x) { return arctangent(y, x); }
void sincosf(float x, float *s, float *c)
{
    *s = sine(x);
    *c = cosine(x);
}
#else
double sin(double x) { return sine(x); }
double cos(double x) { return cosine(x); }
double atan2(double y, double x) { return arctangent(y, x); }
void sincos(double x, double *s, double *c)
{
    *s = sine(x);
    *c = cosine(x);
}
#endif
