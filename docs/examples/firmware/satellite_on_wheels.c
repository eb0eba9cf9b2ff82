/* A satellite led through a quarter of a turn by its three wheels, a thousand times a second.
 *
 * The wheels spin all the while, so that turning the body takes gyroscopic moments. What the planned
 * motion needs is known beforehand from satellite_on_wheels_moment: it is fed forward, and only what
 * the plan does not know, a body five per cent heavier and noise of the sensors, is left to feedback. */
#include "satellite_on_wheels_f32.h"
#include "told.h"

#define CYCLES 12000
#define STEP 1e-3F /* s */
#define SLEW 10.0F /* s that the turn takes; then the satellite rests */
#define WHEEL 0.01F /* kg m^2 */
#define GYRO 1e-4F /* rad/s, of a reading */
#define STARS 1e-5F /* rad, of an axis */

static const float axis[3] = {2.0F / 3.0F, -1.0F / 3.0F, 2.0F / 3.0F}; /* that the plan turns about */

typedef struct {
    float attitude[4], omega[3], omega_dot[3];
} plan;

/* Half the turn has the tangent g = 10 s^3 - 15 s^4 + 6 s^5: no sine is needed. */
static void planned(float time, plan *to)
{
    const float s = time < SLEW ? time / SLEW : 1.0F, r = 1.0F - s;
    const float g = s * s * s * (10.0F - s * (15.0F - 6.0F * s));
    const float rate = 30.0F * s * s * r * r / SLEW;
    const float second = 60.0F * s * r * (r - s) / (SLEW * SLEW);
    const float size = 1.0F + g * g, root = sqrtf(size);
    const float speed = 2.0F * rate / size;
    const float change = 2.0F * (second - 2.0F * g * rate * rate / size) / size;
    to->attitude[0] = 1.0F / root;
    for (int i = 0; i < 3; i++) {
        to->attitude[1 + i] = axis[i] * g / root;
        to->omega[i] = axis[i] * speed;
        to->omega_dot[i] = axis[i] * change;
    }
}

/* Torques of the motors from what the sensors say; ahead tells whether the plan is fed forward. */
static void cycle(const satellite_on_wheels_constants_f32 *known, float time, const float attitude[4],
    const float omega[3], const float wheels[3], int ahead, float torques[3])
{
    static const float steady[3] = {0.0F, 0.0F, 0.0F};
    static const float stiffness[3] = {12.0F, 16.0F, 20.0F}, damping[3] = {8.4F, 11.2F, 14.0F};
    plan to;
    float turn[3], moment[3] = {0.0F, 0.0F, 0.0F};
    planned(time, &to);
    if (ahead) {
        satellite_on_wheels_moment_f32(known, to.omega, wheels, to.omega_dot, steady, moment);
    }
    turn_between(attitude, to.attitude, turn);
    for (int i = 0; i < 3; i++) {
        const float wanted = stiffness[i] * turn[i] + damping[i] * (to.omega[i] - omega[i]);
        torques[i] = (ahead ? WHEEL * to.omega_dot[i] : 0.0F) - moment[i] - wanted;
    }
}

/* Return the largest turn from the plan, and in rest the last one. */
static float flown(const satellite_on_wheels_constants_f32 *known,
    const satellite_on_wheels_constants_f32 *true_ones, int ahead, float *last)
{
    static const float outside[3] = {0.0F, 0.0F, 0.0F};
    float attitude[4] = {1.0F, 0.0F, 0.0F, 0.0F}, omega[3] = {0.0F, 0.0F, 0.0F};
    float wheels[3] = {150.0F, -120.0F, 100.0F}, torques[3], largest = 0.0F;
    uint32_t idle = ticks();
    idle = ticks() - idle;
    for (int n = 0; n < CYCLES; n++) {
        float seen[4], gyro[3], turn[3];
        for (int i = 0; i < 3; i++) {
            gyro[i] = omega[i] + GYRO * normal();
            turn[i] = STARS * normal();
        }
        memcpy(seen, attitude, sizeof seen);
        turned(seen, turn);
        const uint32_t before = ticks();
        cycle(known, STEP * (float)n, seen, gyro, wheels, ahead, torques);
        if (ahead) {
            timed(ticks() - before, idle);
        }
        satellite_on_wheels_step_rk4_f32(
            true_ones, attitude, omega, wheels, outside, torques, STEP, attitude, omega, wheels);
        take(attitude, 4);
        take(omega, 3);
        take(wheels, 3);
        take(torques, 3);
        plan to;
        planned(STEP * (float)(n + 1), &to);
        turn_between(attitude, to.attitude, turn);
        *last = sqrtf(squared(turn));
        largest = *last > largest ? *last : largest;
    }
    return largest;
}

int main(void)
{
    satellite_on_wheels_constants_f32 known, true_ones;
    float last;
    if (satellite_on_wheels_setup_f32(3.0F, 4.0F, 5.0F, WHEEL, &known) != 0
        || satellite_on_wheels_setup_f32(3.15F, 4.2F, 5.25F, WHEEL, &true_ones) != 0) {
        return 1;
    }
    tell("without", millionths(flown(&known, &true_ones, 0, &last)));
    tell("error", millionths(flown(&known, &true_ones, 1, &last)));
    tell("last", millionths(last));
    tell_all();
    return 0;
}
