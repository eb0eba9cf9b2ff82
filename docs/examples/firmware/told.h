/* Noise from a seed, a hash of all bits, and figures to print: the same on a core and on this machine. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "board.h"

static uint32_t seed = 2463534242u, hash[2], shortest = 0xFFFFFFFFu, longest;

/* A number from 0 to 1, by xorshift. */
static float uniform(void)
{
    seed ^= seed << 13;
    seed ^= seed >> 17;
    seed ^= seed << 5;
    return (float)(seed >> 8) * (1.0F / 16777216.0F);
}

/* Near a normal distribution of variance 1: twelve uniform ones less their mean. */
static float normal(void)
{
    float sum = -6.0F;
    for (int i = 0; i < 12; i++) {
        sum += uniform();
    }
    return sum;
}

static void take(const float *x, int n)
{
    for (int i = 0; i < n; i++) {
        unsigned char bytes[sizeof *x];
        memcpy(bytes, &x[i], sizeof *x);
        for (unsigned k = 0; k < sizeof *x; k++) {
            hash[0] = (hash[0] ^ bytes[k]) * 16777619u;
            hash[1] = hash[1] * 1664525u + bytes[k] + 1013904223u;
        }
    }
}

/* Ticks of a cycle, less those of looking at the clock. */
static void timed(uint32_t took, uint32_t idle)
{
    took -= idle < took ? idle : took;
    shortest = took < shortest ? took : shortest;
    longest = took > longest ? took : longest;
}

static void tell(const char *name, uint32_t number)
{
    char text[12] = "";
    int place = 11;
    do {
        text[--place] = (char)('0' + number % 10);
        number /= 10;
    } while (number != 0 && place > 0);
    say(name);
    say(" ");
    say(text + place);
    say("\n");
}

static void tell_all(void)
{
    tell("bits", hash[0]);
    tell("bits", hash[1]);
    tell("least", shortest);
    tell("most", longest);
}

/* The small turn, along the body, that leads from one attitude to another: twice q^-1 p. */
static void turn_between(const float q[4], const float p[4], float turn[3])
{
    const float w = q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3];
    const float two = w < 0.0F ? -2.0F : 2.0F;
    turn[0] = two * (q[0] * p[1] - q[1] * p[0] - (q[2] * p[3] - q[3] * p[2]));
    turn[1] = two * (q[0] * p[2] - q[2] * p[0] - (q[3] * p[1] - q[1] * p[3]));
    turn[2] = two * (q[0] * p[3] - q[3] * p[0] - (q[1] * p[2] - q[2] * p[1]));
}

/* An attitude turned by a small turn along the body: q (1, turn / 2), of length 1. */
static void turned(float q[4], const float turn[3])
{
    const float x = 0.5F * turn[0], y = 0.5F * turn[1], z = 0.5F * turn[2];
    const float p[4] = {
        q[0] - x * q[1] - y * q[2] - z * q[3],
        q[1] + x * q[0] + z * q[2] - y * q[3],
        q[2] + y * q[0] + x * q[3] - z * q[1],
        q[3] + z * q[0] + y * q[1] - x * q[2],
    };
    const float size = sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    for (int i = 0; i < 4; i++) {
        q[i] = p[i] / size;
    }
}

static float squared(const float v[3]) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

/* A small figure in millionths. */
static uint32_t millionths(float x) { return (uint32_t)(x * 1e6F + 0.5F); }
