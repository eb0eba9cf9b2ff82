/* Calls every function of a scene on the same inputs and says, of each, a hash of all bits that it
 * returned, how many values these were, the least and most ticks of a call, and the stack that it
 * used. calls.c, written for the scene, has its functions; a call of one that does nothing is taken
 * off. The first line is of a function of KNOWN instructions, to show what a tick is. */
#include <string.h>

#include "board.h"
#include "calls.h"

#define PAINT 0xA5C3965Au
#define LOOKED_AT 32768u

typedef struct {
    uint32_t hash[2];
    uint32_t values;
    uint32_t least;
    uint32_t most;
    uint32_t stack;
} found;

static uint32_t state = 2463534242u;
static volatile int real;

/* A number between low and high, by xorshift; the same on every machine. */
static scalar between(scalar low, scalar high)
{
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return low + (high - low) * ((scalar)(state >> 8) * (scalar)(1.0 / 16777216.0));
}

static void draw(scalar *x, const scalar (*ranges)[2], int n)
{
    for (int i = 0; i < n; i++) {
        x[i] = between(ranges[i][0], ranges[i][1]);
    }
}

/* A quaternion of length one: the square of any other, over its length. */
static void attitude(scalar *q)
{
    scalar p[4], size = 0;
    do {
        for (int i = 0; i < 4; i++) {
            p[i] = between(-1, 1);
        }
        size = p[0] * p[0] + (p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    } while (size < (scalar)0.01);
    q[0] = (2 * p[0] * p[0] - size) / size;
    for (int i = 1; i < 4; i++) {
        q[i] = 2 * p[0] * p[i] / size;
    }
}

static void take(found *of, const scalar *x, int n)
{
    for (int i = 0; i < n; i++) {
        scalar value = x[i];
        unsigned char bytes[sizeof value];
        memcpy(bytes, &value, sizeof value);
        if (value != value) { /* which NaN it is is left open */
            memset(bytes, 0xFF, sizeof bytes);
        }
        for (size_t k = 0; k < sizeof bytes; k++) {
            of->hash[0] = (of->hash[0] ^ bytes[k]) * 16777619u;
            of->hash[1] = of->hash[1] * 1664525u + bytes[k] + 1013904223u;
        }
        of->values++;
    }
}

static void timed(found *of, uint32_t took, uint32_t stack)
{
    of->least = took < of->least ? took : of->least;
    of->most = took > of->most ? took : of->most;
    of->stack = stack > of->stack ? stack : of->stack;
}

#if defined(ON_TARGET)
#define HERE(place) __asm__ volatile("mv %0, sp" : "=r"(place))
#if defined(__arm__)
#undef HERE
#define HERE(place) __asm__ volatile("mov %0, sp" : "=r"(place))
#endif

static uint32_t *lowest(uintptr_t sp)
{
    const uintptr_t end = (uintptr_t)&bss_end;
    return (uint32_t *)(sp - end > LOOKED_AT ? sp - LOOKED_AT : end);
}

/* Both use registers alone: what lies below the caller's stack is as the call left it. */
__attribute__((noinline)) static void paint(uintptr_t sp)
{
    for (volatile uint32_t *at = lowest(sp); at < (uint32_t *)sp; at++) {
        *at = PAINT;
    }
}

__attribute__((noinline)) static uint32_t touched(uintptr_t sp)
{
    const volatile uint32_t *at = lowest(sp);
    while (at < (const uint32_t *)sp && *at == PAINT) {
        at++;
    }
    return sp - (uintptr_t)at;
}
#else
#define HERE(place) ((place) = 0)
#define paint(sp) ((void)(sp))
#define touched(sp) ((uint32_t)(sp))
#endif

static void hex(uint32_t number)
{
    char text[10] = "00000000 ";
    for (int i = 0; i < 8; i++) {
        text[i] = "0123456789abcdef"[number >> (28 - 4 * i) & 15];
    }
    say(text);
}

/* One call of a function and one that does nothing; PAINTED rounds look at the stack too. */
#define CALL(of, round, pick, ...)                                                              \
    do {                                                                                        \
        uint32_t took_[2];                                                                      \
        uintptr_t sp_;                                                                          \
        for (real = 0; real < 2; real++) {                                                      \
            HERE(sp_);                                                                          \
            if ((round) < PAINTED) {                                                            \
                paint(sp_);                                                                     \
            }                                                                                   \
            const uint32_t before_ = ticks();                                                   \
            (pick)[real](__VA_ARGS__);                                                          \
            took_[real] = ticks() - before_;                                                    \
        }                                                                                       \
        timed(of, took_[1] - took_[0], (round) < PAINTED ? touched(sp_) : 0);                   \
    } while (0)

#define EMPTY __attribute__((noinline)) static

EMPTY void known_empty(void) { __asm__ volatile(""); }

EMPTY void known(void)
{
#if defined(ON_TARGET)
    __asm__ volatile(".rept 1000\n nop\n .endr");
#endif
}

#if defined(OWN_SINE)
#include "sine.c"
#endif
#include "calls.c"

int main(void)
{
    static found known_found = {{0, 0}, 0, 0xFFFFFFFFu, 0, 0};
    void (*const pick[2])(void) = {known_empty, known};
    for (int n = 0; n < FUNCTIONS; n++) {
        all[n].least = 0xFFFFFFFFu;
    }
    for (int round = 0; round < ROUNDS; round++) {
        CALL(&known_found, round, pick);
        calls(round);
    }
    for (int n = -1; n < FUNCTIONS; n++) {
        const found *of = n < 0 ? &known_found : &all[n];
        hex(of->hash[0]);
        hex(of->hash[1]);
        hex(of->values);
        hex(of->least);
        hex(of->most);
        hex(of->stack);
        say("\n");
    }
    return 0;
}
