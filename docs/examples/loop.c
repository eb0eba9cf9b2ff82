/* Turns a satellite to rest by its wheels, a thousand times a second, and prints every hundredth. */
#include <stdio.h>

#include "satellite_on_wheels_f32.h"

#define STEP 1e-3F  /* s */
#define WHEEL 0.01F /* kg m^2 */
#define MOST 0.2F   /* N m of a motor */

int main(void)
{
    satellite_on_wheels_constants_f32 known;
    const float none[3] = {0.0F, 0.0F, 0.0F}; /* outside moments; rates of the wheels */
    float q[4] = {0.8F, 0.36F, -0.48F, 0.0F}, omega[3] = {0.05F, -0.02F, 0.04F};
    float wheels[3] = {150.0F, -120.0F, 100.0F}; /* rad/s */
    if (satellite_on_wheels_setup_f32(3.0F, 4.0F, 5.0F, WHEEL, &known) != 0) {
        return 1;
    }
    for (int n = 0; n <= 20000; n++) {
        float wanted[3], moment[3], torques[3];
        for (int i = 0; i < 3; i++) { /* 0.5 rad/s, damped so that nothing swings */
            wanted[i] = -0.25F * 2.0F * q[1 + i] - 1.0F * omega[i];
        }
        satellite_on_wheels_moment_f32(&known, omega, wheels, wanted, none, moment);
        for (int i = 0; i < 3; i++) {
            const float torque = WHEEL * wanted[i] - moment[i];
            torques[i] = torque > MOST ? MOST : torque < -MOST ? -MOST : torque;
        }
        if (n % 100 == 0) {
            printf("%g %g %g %g %g %g %g\n", STEP * (float)n, q[1], q[2], q[3],
                torques[0], torques[1], torques[2]);
        }
        satellite_on_wheels_step_rk4_f32(
            &known, q, omega, wheels, none, torques, STEP, q, omega, wheels);
    }
    return 0;
}
